#include "session/uncertainty.hpp"

#include <algorithm>
#include <cmath>

#include "capture/format.hpp"
#include "render/renderer.hpp"
#include "session/exposed_picture.hpp"

namespace nutik {
namespace {

using Is = UncertaintyTerm::Is;

// The most that light changes where a code of [0, 1] changes by `fraction`: no function is steeper than at one of its ends.
double light_within(const Transfer& transfer, double fraction) {
  if (!(fraction < 1.0)) return 1.0;
  return std::max(transfer.light_of(fraction) - transfer.light_of(0.0), 1.0 - transfer.light_of(1.0 - fraction));
}

// Light of a capture's scale that is off by so much, as the picture's format has it.
PictureError error_of(const ExposedPicture& exposed, double scale, double light) {
  PictureError error{light, 0.0};
  if (!holds_codes(exposed.output.type)) {
    error.steps = scale > 0.0 ? light / (scale * format_step(exposed.output.type)) : 0.0;
    return error;
  }
  const CodeMaking making = CodeMaking::of(exposed.figures.capture, exposed.output);
  const double seen = making.conversion ? converted_error(*making.conversion, light, scale) : light;
  error.steps = code_error(making.transfer, exposed.output.white_code, {seen / making.white_light, 0.0});
  return error;
}

std::optional<PictureError> rounding_of(const ExposedPicture& exposed, double scale) {
  const OutputFormat& output = exposed.output;
  if (output.type == ValueType::light64) return std::nullopt;
  if (output.type == ValueType::light32) return PictureError{scale * 0x1p-24, 0.5};
  const CodeMaking making = CodeMaking::of(exposed.figures.capture, output);
  const double signs = output.negative == NegativeLight::offset ? 2.0 : 1.0;  // each has half of the codes
  const double half_code = 0.5 * signs / std::max(output.white_code, 2u);
  return PictureError{making.white_light * light_within(making.transfer, half_code), 0.5};
}

double largest_gain(const GainFunction& function) {
  double largest = 0.0;
  for (const ControlPoint& point : function.points()) largest = std::max(largest, std::fabs(point.gain));
  return largest;
}

// Both ends of a sample are rounded to whole nanoseconds, and so is D: the integral misses half of one at each.
double times_of(const ExposureFigures& figures) {
  double largest = 0.0;
  for (const PlannedFunction& function : figures.functions) {
    const GainSummary& gain = function.summary;
    if (gain.support_ns == 0) continue;
    const auto samples = static_cast<double>(exposed_samples(function, figures.timeline).size());
    largest =
        std::max(largest, (samples + 1) / static_cast<double>(gain.support_ns) * largest_gain(function.function));
  }
  return largest;
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

CaptureErrors CaptureErrors::of(const CaptureFormat& capture, bool is_rounded) {
  CaptureErrors errors;
  const NoiseModel& noise = capture.noise;
  const double white = capture.white_code;
  if (is_rounded) errors.rounded_light = light_within(capture.transfer, 0.5 / white);
  errors.held_light = light_within(capture.transfer, noise.tolerance / white);
  if (!noise.camera) return errors;
  const CameraNoise& camera = *noise.camera;
  for (std::uint32_t channel = 0; channel < camera.channels.size(); ++channel) {
    const std::vector<float> deviations = camera.sd_of_codes(channel);
    for (std::size_t code = 0; code < deviations.size(); ++code) {
      const auto light_at = [&](double place) {
        return capture.transfer.light_of(std::clamp(place / camera.white_code, 0.0, 1.0));
      };
      const double place = static_cast<double>(code), deviation = deviations[code];
      const double up = light_at(place + noise.sigmas * deviation) - light_at(place);
      const double down = light_at(place) - light_at(place - noise.sigmas * deviation);
      errors.held_light = std::max({errors.held_light, up, down});
      errors.noise_light =
          std::max(errors.noise_light, (light_at(place + deviation) - light_at(place - deviation)) / 2);
    }
  }
  return errors;
}

Uncertainty Uncertainty::of(const ExposedPicture& exposed, const CaptureErrors& capture) {
  Uncertainty uncertainty;
  const bool adds_up = exposed.figures.combine == Combine::integral;
  for (const PlannedFunction& function : exposed.figures.functions)
    uncertainty.scale =
        std::max(uncertainty.scale, adds_up ? function.summary.error_scale() : largest_gain(function.function));
  const double scale = uncertainty.scale;
  const auto add = [&](std::string_view name, Is is, const PictureError& error) {
    if (error.light > 0.0) uncertainty.terms.push_back({name, is, error});
  };
  add("arithmetic", Is::bound,
      exposed.choice ? exposed.choice->bound.worst : error_of(exposed, scale, scale * kReferenceError));
  if (const auto rounding = rounding_of(exposed, scale)) add("rounding", Is::bound, *rounding);
  add("rounded_codes", Is::bound, error_of(exposed, scale, scale * capture.rounded_light));
  add("held_samples", Is::bound, error_of(exposed, scale, scale * capture.held_light));
  if (adds_up) add("times", Is::bound, error_of(exposed, scale, times_of(exposed.figures)));
  PictureError sum;
  for (const UncertaintyTerm& term : uncertainty.terms) {
    sum.light += term.error->light;
    sum.steps += term.error->steps;
  }
  if (holds_codes(exposed.output.type)) sum.steps = std::min<double>(sum.steps, exposed.output.white_code);
  uncertainty.bounds = {"all_bounds", Is::bound, sum};
  for (UncertaintyTerm& term : uncertainty.terms) {
    term.figures = {{"share_of_bounds", std::isfinite(sum.light) ? term.error->light / sum.light : 1.0}};
    if (term.name == "arithmetic") term.text = to_text(exposed.precision);
  }
  if (capture.noise_light > 0.0)
    add("noise", Is::deviation, error_of(exposed, scale, scale * capture.noise_light));
  if (const auto pixels = capture.alignment_pixels) {
    uncertainty.terms.push_back({"alignment", Is::deviation, {}, {{"residual_pixels", *pixels}},
                                 format("half of the texture lies within {:.2g} pixels of its place", *pixels)});
  }
  if (capture.made) {
    const std::uint64_t made = made_of(exposed.figures, *capture.made), of = exposed.figures.live_samples;
    uncertainty.terms.push_back(
        {"made_samples", Is::count, {},
         {{"made_samples", static_cast<double>(made)}, {"exposed_samples", static_cast<double>(of)}},
         format("{} of {} samples were not filmed", made, of)});
  }
  return uncertainty;
}

namespace {

constexpr std::string_view text_of(Is is) {
  return is == Is::bound ? "bound" : is == Is::deviation ? "deviation" : "count";
}

}  // namespace

std::vector<UncertaintyTerm::Field> UncertaintyTerm::fields(const OutputFormat& output) const {
  std::vector<Field> fields{{"term", name}, {"is", text_of(is)}};
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
    lines.push_back(format("  {:<14}{:<11}{}", name, text_of(term.is), text));
  };
  std::ranges::for_each(terms, add);
  add(bounds);
  return lines;
}

}  // namespace nutik
