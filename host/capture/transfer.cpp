#include "capture/transfer.hpp"

#include <algorithm>
#include <cmath>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"

namespace nutik {
namespace {

// IEC 61966-2-1.
constexpr double kSrgbOffset = 0.055;
constexpr double kSrgbToeFraction = 0.04045;
constexpr double kSrgbToeLight = 0.0031308;
constexpr double kSrgbToeSlope = 12.92;
constexpr double kSrgbExponent = 2.4;

// BT.709 rounds these to 1.099 and 0.018, with which its two pieces miss each other by 2.4e-4: more than
// 15 codes of 16 bits, so that codes would not survive a round trip. BT.2020 gives them in full.
constexpr double kBt709Offset = 0.09929682680944;
constexpr double kBt709ToeLight = 0.018053968510807;
constexpr double kBt709ToeSlope = 4.5;
constexpr double kBt709Exponent = 0.45;

// ITU-R BT.2100, table 5. The third is 1/2 - a ln 4a, in full, so that the two pieces meet.
constexpr double kHlgA = 0.17883277;
constexpr double kHlgB = 1.0 - 4.0 * kHlgA;
constexpr double kHlgC = 0.559910729529562;
constexpr double kHlgRootFraction = 0.5;
constexpr double kHlgReferenceWhite = 0.75;  // BT.2408

// ITU-R BT.2100, table 4.
constexpr double kPqM1 = 2610.0 / 16384;
constexpr double kPqM2 = 2523.0 / 4096 * 128;
constexpr double kPqC1 = 3424.0 / 4096;
constexpr double kPqC2 = 2413.0 / 4096 * 32;
constexpr double kPqC3 = 2392.0 / 4096 * 32;
constexpr double kPqPeak = 10'000.0;         // cd/m²
constexpr double kPqReferenceWhite = 203.0;  // BT.2408

// Light of a camera's black. Half a code of 16 bits is a thousand times as much.
constexpr double kLogBlack = 0x1p-30;
constexpr std::string_view kOfVideo = ":video";

// Black and white of 10 bits of limited range.
constexpr double kVideoBlack = 64.0 / 1023, kVideoSpan = 876.0 / 1023;

double hlg_light(double fraction) {
  if (fraction <= kHlgRootFraction) return fraction <= 0.0 ? 0.0 : fraction * fraction / 3.0;
  // The printed constants pass 1 by 3e-8, and light beyond the last code is nobody's.
  const double light = (std::exp((fraction - kHlgC) / kHlgA) + kHlgB) / 12.0;
  return fraction <= 1.0 ? std::min(light, 1.0) : light;
}

double hlg_fraction(double light) {
  if (light <= 0.0) return 0.0;
  if (light <= kHlgRootFraction * kHlgRootFraction / 3.0) return std::sqrt(3.0 * light);
  return kHlgA * std::log(12.0 * light - kHlgB) + kHlgC;
}

// The standard's formulas, written in what is missing to 1, where c1 = 1 + c3 - c2. As the standard prints them, they
// subtract numbers that are nearly equal, and raise what rounding left to the power of 6.3 or 79.
double pq_light(double fraction) {
  const double missing = -std::expm1(std::log(std::max(fraction, 0.0)) / kPqM2);
  const double over = std::max(1.0 - kPqC1 - missing, 0.0), under = kPqC2 - kPqC3 + kPqC3 * missing;
  return std::exp((over < under / 2 ? std::log(over / under) : std::log1p(-(1.0 + kPqC3) * missing / under)) / kPqM1);
}

double pq_fraction(double light) {
  const double missing = -std::expm1(std::log(std::max(light, 0.0)) * kPqM1);
  return std::exp(std::log1p(-(1.0 - kPqC1) * missing / (1.0 + kPqC3 - kPqC3 * missing)) * kPqM2);
}

}  // namespace

Transfer Transfer::gamma(double exponent) {
  if (!(exponent >= 0.1 && exponent <= 10.0)) {
    throw UsageError(format("transfer gamma:{} is outside gamma:0.1 … gamma:10", exponent));
  }
  return Transfer(Kind::gamma, exponent);
}

Transfer Transfer::log(std::string_view name) {
  const auto curves = log_curves();
  const auto found = std::ranges::find(curves, name, &LogCurve::name);
  if (found == curves.end()) throw UsageError(format("no camera's curve is called {}", name));
  Transfer transfer(Kind::log, 1.0);
  transfer.curve_ = &*found;
  return transfer;
}

std::optional<Primaries> Transfer::usual_primaries() const {
  return curve_ != nullptr ? std::optional(curve_->primaries) : std::nullopt;
}

Transfer Transfer::scaled_from_video() const {
  Transfer scaled = *this;
  scaled.is_of_video_ = is_of_video_ || (curve_ != nullptr && curve_->is_of_whole_codes);
  return scaled;
}

Transfer Transfer::parse(std::string_view text) {
  if (text == "srgb") return srgb();
  if (text == "bt709") return bt709();
  if (text == "linear") return linear();
  if (text == "hlg") return hlg();
  if (text == "pq") return pq();
  constexpr std::string_view kGamma = "gamma:";
  if (text.starts_with(kGamma)) {
    if (const auto exponent = parsed<double>(text.substr(kGamma.size()))) return gamma(*exponent);
  }
  std::string names;
  for (const LogCurve& curve : log_curves()) {
    Transfer log = Transfer::log(curve.name);
    if (text == log.text()) return log;
    log.is_of_video_ = true;
    if (text == log.text()) return log;
    names += format(", {}", curve.name);
  }
  throw UsageError(
      format("transfer '{}' is not known; choose srgb, bt709, linear, gamma:G (as in gamma:2.2), hlg, pq or a "
             "camera's curve{}",
             text, names.replace(0, 1, ":")));
}

std::string Transfer::text() const {
  switch (kind_) {
    case Kind::srgb: return "srgb";
    case Kind::bt709: return "bt709";
    case Kind::linear: return "linear";
    case Kind::gamma: return format("gamma:{}", exponent_);
    case Kind::hlg: return "hlg";
    case Kind::pq: return "pq";
    case Kind::log: return std::string(curve_->name) + std::string(is_of_video_ ? kOfVideo : "");
  }
  return {};
}

double Transfer::light_of(double fraction) const {
  switch (kind_) {
    case Kind::srgb:
      return fraction <= kSrgbToeFraction
                 ? fraction / kSrgbToeSlope
                 : std::pow((fraction + kSrgbOffset) / (1.0 + kSrgbOffset), kSrgbExponent);
    case Kind::bt709:
      return fraction < kBt709ToeSlope * kBt709ToeLight
                 ? fraction / kBt709ToeSlope
                 : std::pow((fraction + kBt709Offset) / (1.0 + kBt709Offset), 1.0 / kBt709Exponent);
    case Kind::linear: return fraction;
    case Kind::gamma: return fraction <= 0.0 ? 0.0 : std::pow(fraction, exponent_);
    case Kind::hlg: return hlg_light(fraction);
    case Kind::pq: return pq_light(fraction);
    case Kind::log: return log_light(fraction);
  }
  return fraction;
}

double Transfer::fraction_of(double light) const {
  switch (kind_) {
    case Kind::srgb:
      return light <= kSrgbToeLight
                 ? light * kSrgbToeSlope
                 : (1.0 + kSrgbOffset) * std::pow(light, 1.0 / kSrgbExponent) - kSrgbOffset;
    case Kind::bt709:
      return light < kBt709ToeLight ? light * kBt709ToeSlope
                                    : (1.0 + kBt709Offset) * std::pow(light, kBt709Exponent) - kBt709Offset;
    case Kind::linear: return light;
    case Kind::gamma: return light <= 0.0 ? 0.0 : std::pow(light, 1.0 / exponent_);
    case Kind::hlg: return hlg_fraction(light);
    case Kind::pq: return pq_fraction(light);
    case Kind::log: return log_fraction(light);
  }
  return light;
}

double Transfer::reference_white() const {
  switch (kind_) {
    case Kind::hlg: return hlg_light(kHlgReferenceWhite);
    case Kind::pq: return kPqReferenceWhite / kPqPeak;
    case Kind::log: return kLogBlack + (1.0 - kLogBlack) / curve_->light_of(signal_of(1.0));
    default: return 1.0;
  }
}

std::optional<Transfer::Toe> Transfer::toe() const {
  switch (kind_) {
    case Kind::srgb: return Toe{kSrgbToeFraction, 1.0 / kSrgbToeSlope};
    case Kind::bt709: return Toe{kBt709ToeSlope * kBt709ToeLight, 1.0 / kBt709ToeSlope};
    case Kind::linear:
    case Kind::gamma:
    case Kind::hlg:
    case Kind::pq:
    case Kind::log: return std::nullopt;
  }
  return std::nullopt;
}

double Transfer::signal_of(double fraction) const {
  return is_of_video_ ? kVideoBlack + kVideoSpan * fraction : fraction;
}

double Transfer::fraction_of_signal(double signal) const {
  return is_of_video_ ? (signal - kVideoBlack) / kVideoSpan : signal;
}

double Transfer::log_light(double fraction) const {
  const double black = fraction_of_signal(curve_->signal_of(0.0));
  if (fraction <= black) return kLogBlack * std::max(fraction, 0.0) / black;
  const double signal = signal_of(fraction), white = curve_->light_of(signal_of(1.0));
  double light = curve_->light_of(signal) / white;
  if (signal >= curve_->toe_end) {
    // From white, beside which signals err least, for there light changes most with them.
    const double power = std::pow(10.0, (is_of_video_ ? kVideoSpan : 1.0) * (fraction - 1.0) / curve_->scale);
    light = power + curve_->offset / (curve_->gain * white) * (power - 1.0);
  }
  return kLogBlack + (1.0 - kLogBlack) * light;
}

double Transfer::log_fraction(double light) const {
  if (light <= kLogBlack) return fraction_of_signal(curve_->signal_of(0.0)) * std::max(light, 0.0) / kLogBlack;
  const double share = (light - kLogBlack) / (1.0 - kLogBlack);
  return fraction_of_signal(curve_->signal_of(share * curve_->light_of(signal_of(1.0))));
}

std::vector<double> Transfer::light_of_codes(std::uint32_t white_code) const {
  std::vector<double> light(static_cast<std::size_t>(white_code) + 1);
  for (std::size_t code = 0; code < light.size(); ++code) {
    light[code] = light_of(static_cast<double>(code) / white_code);
  }
  return light;
}

std::vector<double> Transfer::light_of_all_codes(std::uint32_t white_code, std::uint32_t code_bytes) const {
  std::vector<double> light = light_of_codes(white_code);
  light.resize(std::size_t{1} << (8 * code_bytes), light.back());
  return light;
}

std::vector<double> Transfer::code_thresholds(std::uint32_t white_code) const {
  std::vector<double> thresholds(static_cast<std::size_t>(white_code) + 1);
  for (std::size_t code = 1; code < thresholds.size(); ++code) {
    thresholds[code] = light_of((static_cast<double>(code) - 0.5) / white_code);
  }
  return thresholds;
}

}  // namespace nutik
