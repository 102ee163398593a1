#include "session/uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "capture/format.hpp"
#include "render/renderer.hpp"
#include "session/exposed_picture.hpp"

namespace nutik {
namespace {

using Is = UncertaintyTerm::Is;

// At most so much of white lies between the two pieces of a function that has a toe: sRGB's standard rounds their ends.
constexpr double kPiecesMiss = 3e-8;

// The most that light changes where a code of [0, 1] changes by `fraction`: no function is steeper than at one of its
// ends.
double light_within(const Transfer& transfer, double fraction) {
  if (!(fraction < 1.0)) return 1.0;
  return std::max(transfer.light_of(fraction) - transfer.light_of(0.0), 1.0 - transfer.light_of(1.0 - fraction));
}

// Light of a capture's scale that is off by so much, as the picture's format has it.
PictureError error_of(const ExposedPicture& exposed, double scale, double light) {
  PictureError error{light, 0.0};
  error.steps = holds_codes(exposed.output.type)
                    ? CodeErrors(exposed.figures.capture, exposed.output).anywhere(light, scale)
                : scale > 0.0 ? light / format_step(exposed.output, scale)
                              : 0.0;
  return error;
}

std::optional<PictureError> rounding_of(const ExposedPicture& exposed, double scale) {
  const OutputFormat& output = exposed.output;
  if (output.type == ValueType::light64) return std::nullopt;
  if (output.type == ValueType::light32) {
    const double light = format_step(output, scale) / 2 + (output.is_half ? scale * 0x1p-24 : 0.0);  // rounded twice
    return PictureError{light, scale > 0.0 ? light / format_step(output, scale) : 0.0};
  }
  const CodeMaking making = CodeMaking::of(exposed.figures.capture, output);
  const double signs = output.negative == NegativeLight::offset ? 2.0 : 1.0;  // each has half of the codes
  const double half_code = 0.5 * signs / std::max(output.white_code, 2u);
  return PictureError{making.white_light * light_within(making.transfer, half_code), 0.5};
}

// What codes are off by where off_of(light, light behind it) costs most of a mean of samples between these.
template <typename OffOf>
double largest_codes(const CodeErrors& codes, const Transfer& captured, double scale, OffOf off_of) {
  constexpr int kParts = 1024;  // of the capture's codes
  double largest = 0.0, from = 0.0;
  for (int part = 1; part <= kParts; ++part) {
    const double to = captured.light_of(static_cast<double>(part) / kParts);
    largest = std::max(largest, codes.between(scale * from, scale * to, off_of(from, to)));
    from = to;
  }
  return largest;
}

// How codes were made, where nobody knows how far off that is: by the names that a capture's file has.
UncertaintyTerm without_bound(std::string_view name) {
  static constexpr std::pair<std::string_view, std::string_view> kTexts[] = {
      {"chroma", "chroma that pixels share"},
      {"deflicker", "curves that are estimates; their rounding is among the rounded codes"},
      {"events", "light between two of a pixel's events, and how true the contrast is"},
      {"fields", "lines between those of an interlaced clip's fields"},
      {"interpolation", "light between pixels of aligned pictures, and what their codes were rounded by before"},
      {kUnknown, "how codes were made: an earlier version encoded this capture, or a part of it"},
  };
  for (const auto& [known, text] : kTexts) {
    if (known == name) return {known, Is::no_bound, {}, {}, std::string(text)};
  }
  return {"other", Is::no_bound, {}, {}, "codes that another version made"};
}

// How many samples of those exposed were made.
std::uint64_t made_of(const ExposureFigures& figures, const MadeSamples& made) {
  const std::vector<bool> marks = made.marks();
  std::vector<bool> is_exposed(marks.size());
  for (const PlannedFunction& function : figures.functions) {
    const SampleRange samples = exposed_samples(function, figures.timeline);
    for (std::uint64_t k = samples.first; k < std::min<std::uint64_t>(samples.last, marks.size()); ++k)
      is_exposed[k] = marks[k];
  }
  return static_cast<std::uint64_t>(std::ranges::count(is_exposed, true));
}

}  // namespace

LightCurve::LightCurve(std::vector<Point> points) : points_(std::move(points)) {
  for (const Point& point : points_) {
    if (point.off >= top_.off) top_ = point;
  }
  if (top_.off == 0.0) points_.clear();
}

LightCurve LightCurve::above(const std::vector<Point>& points) {
  std::vector<Point> hull;
  for (const Point& point : points) {
    const auto is_below = [&](const Point& a, const Point& b) {
      return (b.off - a.off) * (point.light - a.light) <= (point.off - a.off) * (b.light - a.light);
    };
    while (hull.size() > 1 && is_below(hull[hull.size() - 2], hull.back())) hull.pop_back();
    hull.push_back(point);
  }
  return LightCurve(std::move(hull));
}

// The lightest sample that is held may not have been the lightest. The one that was is held as no brighter, and was
// brighter by no more than such light may be off by. The darkest likewise.
LightCurve LightCurve::of_order() const {
  std::vector<Point> points = points_;
  double brightest = 0.0, darkest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    brightest = std::max(brightest, points_[i].light + points_[i].off);
    points[i].off = brightest - points_[i].light;
  }
  for (std::size_t i = points.size(); i-- > 0;) {
    darkest = std::min(darkest, points_[i].light - points_[i].off);
    points[i].off = std::max(points[i].off, points_[i].light - darkest);
  }
  return above(points);
}

double LightCurve::at(double light) const {
  if (points_.empty()) return 0.0;
  const auto behind = std::ranges::lower_bound(points_, light, {}, &Point::light);
  if (behind == points_.begin()) return points_.front().off;
  if (behind == points_.end()) return points_.back().off;
  const Point &a = behind[-1], &b = *behind;
  return a.off + (b.off - a.off) * ((light - a.light) / (b.light - a.light));
}

double LightCurve::most(double from, double to) const {
  return from <= top_.light && top_.light <= to ? most() : std::max(at(from), at(to));
}

CaptureErrors CaptureErrors::of(const CaptureFormat& capture, const CodeRoundings& roundings) {
  CaptureErrors errors;
  for (const std::string& name : roundings.unbounded) errors.unbounded.emplace_back(without_bound(name).name);
  const NoiseModel& noise = capture.noise;
  const double white = capture.white_code;
  if (roundings.are_none() && noise.tolerance == 0 && !noise.camera) return errors;
  const auto light_at = [&](double code) { return capture.transfer.light_of(std::clamp(code / white, 0.0, 1.0)); };
  const auto within = [&](double code, double off) {
    const double light = light_at(code);
    return LightCurve::Point{light, std::max(light_at(code + off) - light, light - light_at(code - off))};
  };
  const double scale = noise.camera ? white / noise.camera->white_code : 1.0;
  std::vector<LightCurve::Point> rounded, held, noisy;
  for (std::uint32_t code = 0; code <= capture.white_code; ++code) {
    double deviation = 0.0;
    for (std::uint32_t channel = 0; noise.camera && channel < noise.camera->channels.size(); ++channel)
      deviation = std::max(deviation, scale * noise.camera->sd(channel, code / scale));
    if (!roundings.are_none()) rounded.push_back(within(code, scale * roundings.codes));
    held.push_back(within(code, std::max<double>(noise.tolerance, noise.sigmas * deviation)));
    if (deviation > 0.0)
      noisy.push_back({held.back().light, (light_at(code + deviation) - light_at(code - deviation)) / 2});
  }
  errors.rounded = LightCurve::above(rounded);
  errors.held = LightCurve::above(held);
  errors.noise = LightCurve(std::move(noisy));
  return errors;
}

CaptureErrors CaptureErrors::of_order() const {
  CaptureErrors errors = *this;
  errors.rounded = rounded.of_order();
  errors.held = held.of_order();
  return errors;
}

CodeErrors::CodeErrors(const CaptureFormat& capture, const OutputFormat& output)
    : making_(CodeMaking::of(capture, output)), white_code_(output.white_code) {}

double CodeErrors::between(double from, double to, double light) const {
  if (!(light > 0.0)) return 0.0;
  const Transfer& transfer = making_.transfer;
  const double white = making_.white_light, off = light / white;
  const auto place = [&](double at) { return transfer.fraction_of(std::clamp(at, 0.0, 1.0)); };
  const double dark = std::clamp(from / white, 0.0, 1.0), bright = std::clamp(to / white, 0.0, 1.0);
  double largest = 0.0;
  if (transfer.kind() == Transfer::Kind::log) {
    // Which bends both ways: between the ends of each part of a code.
    constexpr int kParts = 32;
    const double first = place(dark), last = place(bright);
    double below = dark;
    for (int part = 1; part <= kParts; ++part) {
      const double end = transfer.light_of(std::lerp(first, last, static_cast<double>(part) / kParts));
      const double above = part == kParts ? bright : std::max(below, end);
      largest = std::max({largest, place(above + off) - place(below), place(above) - place(below - off)});
      below = above;
    }
    return white_code_ * largest;
  }
  // Up and down from a light. Where the function bends down, the step up is largest at the darkest light, the step down
  // at the darkest that has room for all of it; where it bends up, the step down is largest at the brightest light, the
  // step up at the brightest that has room for all of it.
  for (const double at : {dark, bright, std::clamp(off, dark, bright), std::clamp(1.0 - off, dark, bright)})
    largest = std::max({largest, place(at + off) - place(at), place(at) - place(at - off)});
  return white_code_ * (largest + (transfer.toe() ? kPiecesMiss : 0.0));
}

double CodeErrors::anywhere(double light, double scale) const {
  const double seen = making_.conversion ? converted_error(*making_.conversion, light, scale) : light;
  return code_error(making_.transfer, white_code_, {seen / making_.white_light, 0.0});
}

double times_error(const PlannedFunction& function, const Timeline& timeline) {
  const GainSummary& gain = function.summary;
  if (gain.support_ns == 0) return 0.0;
  const auto samples = static_cast<double>(exposed_samples(function, timeline).size());
  return (samples + 1) / static_cast<double>(gain.support_ns) * function.function.largest_gain();
}

bool is_mean(const PlannedFunction& function) {
  return std::ranges::all_of(function.function.points(), [](const ControlPoint& point) { return point.gain >= 0.0; });
}

Uncertainty Uncertainty::of(const ExposedPicture& exposed, const CaptureErrors& capture) {
  Uncertainty uncertainty;
  const ExposureFigures& figures = exposed.figures;
  const bool adds_up = figures.combine == Combine::integral;
  const double scale = uncertainty.scale = figures.error_scale;
  const auto add = [&](UncertaintyTerm::Known which, const PictureError& error, std::string text = {}) {
    const auto& [name, is, covers] = UncertaintyTerm::kKinds[which];
    if (error.light > 0.0) uncertainty.terms.push_back({name, is, error, {}, std::move(text)});
    return error.light;
  };
  double others = 0.0;  // light that is off wherever it lies
  others += add(UncertaintyTerm::kArithmetic,
                exposed.choice && adds_up ? exposed.choice->bound.worst
                                          : error_of(exposed, scale, scale * kReferenceError),
                to_text(exposed.precision));
  if (const auto rounding = rounding_of(exposed, scale)) add(UncertaintyTerm::kRounding, *rounding);
  // The dark is closer to what it was than the bright, in light.
  const CodeErrors codes(figures.capture, exposed.output);
  const bool by_light = holds_codes(exposed.output.type) && !codes.making().conversion &&
                        !(capture.held.is_zero() && capture.rounded.is_zero()) &&
                        std::ranges::all_of(figures.functions, is_mean);
  const auto add_by_light = [&](UncertaintyTerm::Known which, const LightCurve& curve, auto off_of) {
    PictureError error = error_of(exposed, scale, scale * curve.most());
    if (by_light && error.light > 0.0)
      error.steps = std::min(error.steps, largest_codes(codes, figures.capture.transfer, scale, off_of));
    add(which, error);
  };
  const auto held = [&](double from, double to) { return scale * capture.held.most(from, to); };
  const auto rounded = [&](double from, double to) {
    const double before = capture.held.most(from, to);  // light that was rounded, and held after that
    return scale * capture.rounded.most(from - before, to + before);
  };
  add_by_light(UncertaintyTerm::kRoundedCodes, capture.rounded, rounded);
  add_by_light(UncertaintyTerm::kHeldSamples, capture.held, held);
  if (adds_up) others += add(UncertaintyTerm::kTimes, error_of(exposed, scale, figures.times_error));
  PictureError sum;
  for (const UncertaintyTerm& term : uncertainty.terms) {
    sum.light += term.error->light;
    sum.steps += term.error->steps;
  }
  if (by_light) {
    others += codes.making().white_light * threshold_error(exposed.precision);
    const auto all = [&](double from, double to) { return rounded(from, to) + held(from, to) + others; };
    sum.steps = std::min(sum.steps, largest_codes(codes, figures.capture.transfer, scale, all) + 0.5);
  }
  if (holds_codes(exposed.output.type)) sum.steps = std::min<double>(sum.steps, exposed.output.white_code);
  uncertainty.bounds = {UncertaintyTerm::kKinds[UncertaintyTerm::kAllBounds].name, Is::bound, sum};
  for (UncertaintyTerm& term : uncertainty.terms) {
    term.figures = {{"share_of_bounds", std::isfinite(sum.light) ? term.error->light / sum.light : 1.0}};
  }
  add(UncertaintyTerm::kNoise, error_of(exposed, scale, scale * capture.noise.most()));
  if (const auto pixels = capture.alignment_pixels) {
    uncertainty.terms.push_back({UncertaintyTerm::kKinds[UncertaintyTerm::kAlignment].name, Is::deviation, {},
                                 {{"residual_pixels", *pixels}},
                                 format("half of the texture lies within {:.2g} pixels of its place", *pixels)});
  }
  for (const std::string& name : capture.unbounded) uncertainty.terms.push_back(without_bound(name));
  if (capture.made) {
    const std::uint64_t made = made_of(figures, *capture.made), of = figures.live_samples;
    uncertainty.terms.push_back(
        {UncertaintyTerm::kKinds[UncertaintyTerm::kMadeSamples].name, Is::count, {},
         {{"made_samples", static_cast<double>(made)}, {"exposed_samples", static_cast<double>(of)}},
         format("{} of {} samples were not filmed", made, of)});
  }
  return uncertainty;
}

std::string_view to_text(UncertaintyTerm::Is is) {
  return is == Is::bound ? "bound" : is == Is::deviation ? "deviation" : is == Is::count ? "count" : "no_bound";
}

std::vector<UncertaintyTerm::Field> UncertaintyTerm::fields(const OutputFormat& output) const {
  std::vector<Field> fields{{"term", name}, {"is", to_text(is)}};
  if (error) {
    fields.emplace_back("light", error->light);
    fields.emplace_back(holds_codes(output.type) ? "codes" : "float_steps", error->steps);
  }
  for (const auto& [figure, value] : figures) fields.emplace_back(figure, value);
  return fields;
}

std::vector<std::string> Uncertainty::lines(const OutputFormat& output) const {
  std::vector<std::string> lines{format("uncertainty, S = {:.4g}:", scale)};
  const auto add = [&](const UncertaintyTerm& term) {
    std::string text = term.error ? error_text(*term.error, output) : std::string();
    if (!term.text.empty()) text += (text.empty() ? "" : ", ") + term.text;
    std::string name(term.name);
    std::ranges::replace(name, '_', ' ');
    std::string is(to_text(term.is));
    std::ranges::replace(is, '_', ' ');
    lines.push_back(format("  {:<14}{:<11}{}", name, is, text));
  };
  std::ranges::for_each(terms, add);
  add(bounds);
  return lines;
}

}  // namespace nutik
