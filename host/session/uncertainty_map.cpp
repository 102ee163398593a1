#include "session/uncertainty_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "capture/format.hpp"
#include "capture/text.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

double value_of(const Picture& picture, std::uint64_t at) {
  switch (picture.type) {
    case ValueType::code8: return picture.values<std::uint8_t>()[at];
    case ValueType::code16: return picture.values<std::uint16_t>()[at];
    case ValueType::light32: return double{picture.values<float>()[at]};
    case ValueType::light64: return picture.values<double>()[at];
  }
  return 0.0;
}

float rounded_up(double value) {
  return value == 0.0 ? 0.0F : std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity());
}

ColourMatrix inverse(const ColourMatrix& matrix) {
  const auto minor = [&](std::size_t row, std::size_t column) {
    const std::size_t r = (row + 1) % 3, s = (row + 2) % 3, c = (column + 1) % 3, d = (column + 2) % 3;
    return matrix[r][c] * matrix[s][d] - matrix[r][d] * matrix[s][c];
  };
  const double determinant = matrix[0][0] * minor(0, 0) + matrix[0][1] * minor(0, 1) + matrix[0][2] * minor(0, 2);
  ColourMatrix result;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) result[row][column] = minor(column, row) / determinant;
  }
  return result;
}

double made_share(const PlannedFunction& function, const Timeline& timeline, const std::vector<bool>& is_made) {
  const SampleRange samples = exposed_samples(function, timeline);
  if (samples.size() == 0) return 0.0;
  const auto at = [&](std::uint64_t sample) {
    return is_made.begin() + static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(sample, is_made.size()));
  };
  const auto made = std::count(at(samples.first), at(samples.last), true);
  return static_cast<double>(made) / static_cast<double>(samples.size());
}

}  // namespace

UncertaintyMap::UncertaintyMap(const RenderPlan& plan, const Timeline& timeline, const ErrorBound& bound,
                               const CaptureErrors& capture)
    : plan_(plan),
      capture_(capture),
      output_(bound.output),
      arithmetic_(plan, bound),
      codes_(plan.capture, bound.output),
      threshold_(codes_.making().white_light * threshold_error(bound.precision)) {
  const std::vector<bool> is_made = capture.made ? capture.made->marks() : std::vector<bool>();
  for (const PlannedFunction& function : plan.functions) {
    functions_.push_back({error_scale(function, plan.combine),
                          plan.combine == Combine::integral ? times_error(function, timeline) : 0.0,
                          made_share(function, timeline, is_made), nutik::is_mean(function)});
  }
  if (const auto& conversion = codes_.making().conversion) back_ = inverse(*conversion);
}

bool UncertaintyMap::has(Term term) const {
  switch (term) {
    case kRounding: return output_.type != ValueType::light64;
    case kRoundedCodes: return !capture_.rounded.is_zero();
    case kHeldSamples: return !capture_.held.is_zero();
    case kTimes: return plan_.combine == Combine::integral;
    case kNoise: return !capture_.noise.is_zero();
    case kAlignment: return capture_.alignment_pixels.has_value();
    case kMadeSamples: return capture_.made.has_value();
    default: return true;
  }
}

UncertaintyMap::Errors UncertaintyMap::worst_of(Errors a, const Errors& b) {
  for (std::size_t term = 0; term < kTerms; ++term) a.of[term] = std::max(a.of[term], b.of[term]);
  return a;
}

UncertaintyMap::Function UncertaintyMap::function_of(std::uint64_t pixel) const {
  const std::span<const Share> shares = plan_.shares_of(pixel);
  if (shares.empty()) return functions_[plan_.function_of(pixel)];
  Function mixed;
  for (const Share& share : shares) {
    const Function& own = functions_[share.of];
    const double size = static_cast<double>(share.size) / kWholeShare;
    mixed.scale += size * own.scale;
    mixed.times += size * own.times;
    mixed.made += size * own.made;
    mixed.is_mean &= own.is_mean;
  }
  return mixed;
}

UncertaintyMap::Errors UncertaintyMap::lights(const Span& light, const Function& function, double own) const {
  const double scale = function.scale;
  const auto most = [&](const LightCurve& curve, double more) {
    return scale == 0.0       ? 0.0
           : function.is_mean ? scale * curve.most((light.from - more) / scale, (light.to + more) / scale)
                              : scale * curve.most();
  };
  Errors errors;
  errors.of[kArithmetic] = own;
  errors.of[kHeldSamples] = most(capture_.held, own);
  errors.of[kRoundedCodes] = most(capture_.rounded, own + errors.of[kHeldSamples]);  // before they were held
  errors.of[kTimes] = function.times;
  if (scale > 0.0)
    errors.of[kNoise] = scale * (function.is_mean ? capture_.noise.at(light.at / scale) : capture_.noise.most());
  return errors;
}

UncertaintyMap::Span UncertaintyMap::shown(double code, const Span& all) const {
  const CodeMaking& making = codes_.making();
  const double white = output_.white_code;
  const auto light_of = [&](double place) { return making.white_light * making.transfer.light_of(place / white); };
  return {code > 0 ? light_of(code - 0.5) : all.from, light_of(std::min(code, white)),
          code < white ? light_of(code + 0.5) : std::max(all.to, making.white_light)};
}

UncertaintyMap::Errors UncertaintyMap::in_codes(const std::optional<Span>& shown, const Errors& light, double scale,
                                                const PictureError& arithmetic) const {
  const auto steps = [&](double off) {
    return shown ? codes_.between(shown->from, shown->to, off) : codes_.anywhere(off, scale);
  };
  Errors errors;
  errors.of[kArithmetic] = arithmetic.steps;
  errors.of[kRounding] = 0.5;
  double all = light.of[kArithmetic] + threshold_;
  for (const Term term : {kRoundedCodes, kHeldSamples, kTimes}) {
    errors.of[term] = steps(light.of[term]);
    all += light.of[term];
  }
  errors.of[kAllBounds] = std::min<double>(output_.white_code, 0.5 + steps(all));
  errors.of[kNoise] = shown ? codes_.between(shown->at, shown->at, light.of[kNoise]) : steps(light.of[kNoise]);
  return errors;
}

UncertaintyMap::Errors UncertaintyMap::of_code(double code, const Function& function,
                                               const PictureError& arithmetic) const {
  if (!function.is_mean || codes_.making().conversion || output_.negative == NegativeLight::offset) {
    Function unknown = function;  // where its light lies
    unknown.is_mean = false;
    return in_codes(std::nullopt, lights({}, unknown, arithmetic.light), function.scale, arithmetic);
  }
  const Span light = shown(code, {0.0, 0.0, function.scale});
  return in_codes(light, lights(light, function, arithmetic.of_light(light.to)), function.scale, arithmetic);
}

UncertaintyMap::Errors UncertaintyMap::of_colour(const std::array<double, 3>& codes, const Function& function,
                                                 const PictureError& arithmetic) const {
  if (!function.is_mean || output_.negative != NegativeLight::saturate) return of_code(0.0, function, arithmetic);
  const ColourMatrix& to_shown = *codes_.making().conversion;
  const double own = converted_error(to_shown, arithmetic.light, function.scale);
  std::array<Span, 3> seen, light;
  for (std::size_t row = 0; row < 3; ++row) {
    Span all;
    for (const double entry : to_shown[row]) (entry < 0.0 ? all.from : all.to) += entry * function.scale;
    seen[row] = shown(codes[row], all);
  }
  std::array<Errors, 3> of_light, of_shown{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const double entry = back_[row][channel], from = seen[channel].from - own, to = seen[channel].to + own;
      light[row].from += entry * (entry < 0.0 ? to : from);
      light[row].at += entry * seen[channel].at;
      light[row].to += entry * (entry < 0.0 ? from : to);
    }
    for (double* const end : {&light[row].from, &light[row].at, &light[row].to})
      *end = std::clamp(*end, 0.0, function.scale);
    of_light[row] = lights(light[row], function, arithmetic.light);
  }
  Errors worst;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      for (std::size_t term = 0; term < kTerms; ++term)
        of_shown[row].of[term] += std::fabs(to_shown[row][channel]) * of_light[channel].of[term];
    }
    of_shown[row].of[kArithmetic] = own;
    worst = worst_of(worst, in_codes(seen[row], of_shown[row], function.scale, arithmetic));
  }
  return worst;
}

UncertaintyMap::Errors UncertaintyMap::of_light(double light, const Function& function,
                                                const PictureError& arithmetic) const {
  // Half a step of the float that it became, the least one at the end.
  const double rounding = output_.type == ValueType::light32 ? std::fabs(light) * 0x1p-24 + 0x1p-150 : 0.0;
  Errors errors = lights({light, light, light}, function, arithmetic.light + rounding);
  errors.of[kArithmetic] = arithmetic.light;
  errors.of[kRounding] = rounding;
  for (const Term term : {kArithmetic, kRounding, kRoundedCodes, kHeldSamples, kTimes})
    errors.of[kAllBounds] += errors.of[term];
  return errors;
}

double UncertaintyMap::slope_at(const Picture& exposed, std::uint32_t x, std::uint32_t y) {
  const std::uint32_t width = exposed.shape.width, height = exposed.shape.height, channels = exposed.shape.channels;
  const std::uint32_t left = x - (x > 0), right = std::min(x + 1, width - 1);
  const std::uint32_t above = y - (y > 0), below = std::min(y + 1, height - 1);
  double largest = 0.0;
  for (std::uint32_t channel = 0; channel < channels; ++channel) {
    const auto at = [&](std::uint32_t column, std::uint32_t row) {
      return value_of(exposed, (std::uint64_t{row} * width + column) * channels + channel);
    };
    const double across = right > left ? (at(right, y) - at(left, y)) / (right - left) : 0.0;
    const double down = below > above ? (at(x, below) - at(x, above)) / (below - above) : 0.0;
    largest = std::max(largest, std::hypot(across, down));
  }
  return largest;
}

std::vector<PictureLayer> UncertaintyMap::layers(const Picture& exposed, const Rectangle& part,
                                                 const RenderControl& control) const {
  const bool is_codes = holds_codes(output_.type);
  const std::uint32_t channels = exposed.shape.channels;
  std::vector<PictureLayer> layers;
  std::array<float*, kTerms> values{};
  for (std::size_t term = kAllBounds; term < kTerms; ++term) {
    if (!has(static_cast<Term>(term))) continue;
    PictureLayer layer{std::string(UncertaintyTerm::kKinds[term].name), text_of(static_cast<Term>(term)),
                       Picture({part.width, part.height, 1}, ValueType::light32, 0)};
    layer.values.pixel_aspect = exposed.pixel_aspect;
    values[term] = layer.values.values<float>().data();  // which stay in place
    layers.push_back(std::move(layer));
  }
  // What a thread has found for pixels that one function has alone, by function and codes.
  using Known = std::unordered_map<std::uint64_t, Errors>;
  constexpr std::size_t kMostKnown = 1 << 16;
  const auto known_or = [&](std::uint64_t key, Known& known, const auto& find) {
    if (known.size() >= kMostKnown) known.clear();
    const auto [found, is_new] = known.try_emplace(key);
    if (is_new) found->second = find();
    return found->second;
  };
  const auto errors_of = [&](double value, std::uint64_t pixel, const Function& function,
                             const PictureError& arithmetic, Known& known) {
    if (!is_codes) return of_light(value, function, arithmetic);
    if (!plan_.shares_of(pixel).empty()) return of_code(value, function, arithmetic);
    const std::uint64_t key = std::uint64_t{plan_.function_of(pixel)} << 16 | static_cast<std::uint64_t>(value);
    return known_or(key, known, [&] { return of_code(value, function, arithmetic); });
  };
  const auto errors_of_colour = [&](const std::array<double, 3>& codes, std::uint64_t pixel, const Function& function,
                                    const PictureError& arithmetic, Known& known) {
    const auto find = [&] { return of_colour(codes, function, arithmetic); };
    if (!plan_.shares_of(pixel).empty()) return find();
    std::uint64_t key = plan_.function_of(pixel);
    for (const double code : codes) key = key << 16 | static_cast<std::uint64_t>(code);
    return known_or(key, known, find);
  };
  const bool has_colour = is_codes && codes_.making().conversion;
  const auto make_row = [&](std::uint32_t y, Known& known) {
    for (std::uint32_t x = 0; x < part.width; ++x) {
      const std::uint64_t pixel = std::uint64_t{part.y + y} * plan_.capture.shape.width + part.x + x;
      const std::uint64_t at = std::uint64_t{y} * part.width + x;
      const Function function = function_of(pixel);
      const PictureError arithmetic = arithmetic_.of(pixel);
      const auto value = [&](std::uint32_t channel) { return value_of(exposed, at * channels + channel); };
      Errors worst;
      if (has_colour) worst = errors_of_colour({value(0), value(1), value(2)}, pixel, function, arithmetic, known);
      for (std::uint32_t channel = 0; channel < channels && !has_colour; ++channel)
        worst = worst_of(worst, errors_of(value(channel), pixel, function, arithmetic, known));
      if (capture_.alignment_pixels) worst.of[kAlignment] = *capture_.alignment_pixels * slope_at(exposed, x, y);
      worst.of[kMadeSamples] = function.made;
      for (std::size_t term = 0; term < kTerms; ++term) {
        if (values[term] != nullptr)
          values[term][at] = term == kMadeSamples ? static_cast<float>(worst.of[term]) : rounded_up(worst.of[term]);
      }
    }
  };
  std::mutex progress_mutex;
  std::uint64_t rows = 0;
  parallel_for_with(part.height, [] { return Known(); }, [&](std::uint64_t y, Known& known) {
    throw_if_cancelled(control);
    make_row(static_cast<std::uint32_t>(y), known);
    if (!control.progress) return;
    const std::scoped_lock lock(progress_mutex);
    control.progress(++rows, part.height);
  });
  return layers;
}

void UncertaintyMap::limit(std::vector<PictureLayer>& layers, const PictureError& bounds) {
  const float most = rounded_up(bounds.steps);
  for (float& value : layers.at(kAllBounds).values.values<float>()) value = std::min(value, most);
}

std::string UncertaintyMap::text_of(Term term) const {
  const UncertaintyTerm::Kind& kind = UncertaintyTerm::kKinds[term];
  const std::string unit = term == kMadeSamples         ? "samples"
                           : !holds_codes(output_.type) ? "light, of which 1 is white"
                                                       : format("codes, of which {} is white", output_.white_code);
  const bool is_short = term == kAllBounds && !capture_.unbounded.empty();
  return format("{}: a {}, in {}: {}{}", kind.name, to_text(kind.is), unit, kind.covers,
                is_short ? "; without a bound: " + joined(capture_.unbounded) : "");
}

}  // namespace nutik
