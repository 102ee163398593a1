#include "render/picture_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "render/code_scale.hpp"

namespace nutik {
namespace {

constexpr double kInfiniteError = std::numeric_limits<double>::infinity();

// In u₆₄ of the white code: what a place on the scale of codes is computed to (the inverse transfer function's power,
// quotient and product).
constexpr double kPlaceRoundings = 32;
constexpr double kRoundoff = 0x1p-53;

void check(const RenderPlan& plan, const Picture& expected, const Picture& picture) {
  if (expected.shape != plan.capture.shape || picture.shape != plan.capture.shape) {
    throw std::logic_error("pictures of another shape than their plan's were compared");
  }
}

// Where light lies on the scale of codes 0 … white_code, before it is rounded to one.
double place_of(const Transfer& transfer, double light, std::uint32_t white_code) {
  return transfer.fraction_of(std::clamp(light, 0.0, 1.0)) * white_code;
}

// Light of the plan's capture as the codes of `output` are made of it.
Picture shown(const RenderPlan& plan, const OutputFormat& output, Picture light) {
  to_shown_light(light, CodeMaking::of(plan.capture, output));
  return light;
}

// How far `place` lies from the places that round to `code`, which for black and white go on without end.
double distance_to_code(double place, double code, double white_code) {
  const double below = code == 0.0 ? 0.0 : code - 0.5 - place;
  const double above = code == white_code ? 0.0 : place - (code + 0.5);
  return std::max({below, above, 0.0});
}

// The largest distance of both on the scale of codes, of which white is 1: all of it where light is no number.
double worst_share_of_white(const RenderPlan& plan, const OutputFormat& output, const Picture& expected,
                            const Picture& light) {
  const Picture wanted = shown(plan, output, expected), found = shown(plan, output, light);
  const Transfer transfer = CodeMaking::of(plan.capture, output).transfer;
  double worst = 0.0;
  for (std::uint64_t i = 0; i < wanted.shape.value_count(); ++i) {
    const double share = std::fabs(place_of(transfer, found.values<double>()[i], 1) -
                                   place_of(transfer, wanted.values<double>()[i], 1));
    worst = std::isnan(found.values<double>()[i]) ? 1.0 : std::max(worst, share);
  }
  return worst;
}

template <typename Code>
StoredErrors code_errors(const RenderPlan& plan, const ErrorBound& bound, const Picture& expected,
                         const Picture& picture) {
  StoredErrors errors{picture.shape.value_count(), 0, 0};
  const double white = picture.white_code;
  const auto codes = picture.values<Code>();
  const Picture wanted = shown(plan, bound.output, expected);
  const auto light = wanted.values<double>();
  const PixelErrors bounds(plan, bound);
  const Transfer transfer = CodeMaking::of(plan.capture, bound.output).transfer;
  for (std::uint64_t i = 0; i < errors.values; ++i) {
    const double place = place_of(transfer, light[i], picture.white_code);
    const double code = codes[i];
    if (code == std::floor(place + 0.5)) continue;
    ++errors.differing;
    const double allowed =
        bounds.of(i / plan.capture.shape.channels).steps + kPlaceRoundings * kRoundoff * picture.white_code;
    if (code <= white && distance_to_code(place, code, white) <= allowed) ++errors.explained;
  }
  return errors;
}

template <typename Real>
StoredErrors real_errors(const RenderPlan& plan, const ErrorBound& bound, const Picture& expected,
                         const Picture& picture) {
  StoredErrors errors{picture.shape.value_count(), 0, 0};
  const auto reals = picture.values<Real>();
  const auto light = expected.values<double>();
  const PixelErrors bounds(plan, bound);
  for (std::uint64_t i = 0; i < errors.values; ++i) {
    if (reals[i] == static_cast<Real>(light[i])) continue;
    ++errors.differing;
    // Rounding keeps the order, also beyond the largest number: what lies between is what some light within the
    // bound is stored as. Never where it is no number.
    const double allowed = bounds.of(i / plan.capture.shape.channels).of_light(light[i]);
    if (static_cast<Real>(light[i] - allowed) <= reals[i] &&
        reals[i] <= static_cast<Real>(light[i] + allowed)) {
      ++errors.explained;
    }
  }
  return errors;
}

// The error is above 0.
double share_of(double error, double allowed) {
  if (std::isnan(error)) return kInfiniteError;  // no bound allows what is no number
  if (std::isinf(allowed)) return std::isinf(error) ? 1.0 : 0.0;
  return error / allowed;
}

}  // namespace

LightErrors light_errors(const RenderPlan& plan, const ErrorBound& bound, const Picture& expected,
                         const Picture& light) {
  check(plan, expected, light);
  const auto wanted = expected.values<double>();
  const auto found = light.values<double>();
  const PixelErrors bounds(plan, bound);
  LightErrors errors;
  for (std::uint64_t i = 0; i < wanted.size(); ++i) {
    if (found[i] == wanted[i]) continue;
    double error = std::fabs(found[i] - wanted[i]);
    const double allowed = bounds.of(i / plan.capture.shape.channels).of_light(wanted[i]);
    if (const double share = share_of(error, allowed); share > errors.share_of_bound) {
      errors.share_of_bound = share;
      errors.bounded_error = std::isnan(error) ? kInfiniteError : error;
      errors.bound = allowed;
    }
    if (std::isnan(error)) error = kInfiniteError;
    if (error > errors.worst) {
      errors.worst = error;
      errors.worst_value = i;
    }
    errors.rms = std::hypot(errors.rms, error);  // squares of large light would overflow
  }
  errors.rms /= std::sqrt(static_cast<double>(std::max<std::size_t>(1, wanted.size())));
  const double share_of_white = worst_share_of_white(plan, bound.output, expected, light);
  errors.worst_8_bit_codes = 255 * share_of_white;
  errors.worst_16_bit_codes = 65'535 * share_of_white;
  return errors;
}

StoredErrors stored_errors(const RenderPlan& plan, const ErrorBound& bound, const Picture& expected,
                           const Picture& picture) {
  check(plan, expected, picture);
  switch (picture.type) {
    case ValueType::code8: return code_errors<std::uint8_t>(plan, bound, expected, picture);
    case ValueType::code16: return code_errors<std::uint16_t>(plan, bound, expected, picture);
    case ValueType::light32: return real_errors<float>(plan, bound, expected, picture);
    case ValueType::light64: break;
  }
  return real_errors<double>(plan, bound, expected, picture);
}

}  // namespace nutik
