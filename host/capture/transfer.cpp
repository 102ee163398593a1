#include "capture/transfer.hpp"

#include <charconv>
#include <cmath>

#include "capture/error.hpp"
#include "capture/format.hpp"

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

}  // namespace

Transfer Transfer::gamma(double exponent) {
  if (!(exponent >= 0.1 && exponent <= 10.0)) {
    throw UsageError(format("transfer gamma:{} is outside gamma:0.1 … gamma:10", exponent));
  }
  return Transfer(Kind::gamma, exponent);
}

Transfer Transfer::parse(std::string_view text) {
  if (text == "srgb") return srgb();
  if (text == "bt709") return bt709();
  if (text == "linear") return linear();
  constexpr std::string_view kGamma = "gamma:";
  if (text.starts_with(kGamma)) {
    const std::string_view number = text.substr(kGamma.size());
    double exponent = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), exponent);
    if (error == std::errc() && end == number.data() + number.size()) return gamma(exponent);
  }
  throw UsageError(
      format("transfer '{}' is not known; choose srgb, bt709, linear or gamma:G (as in gamma:2.2)", text));
}

std::string Transfer::text() const {
  switch (kind_) {
    case Kind::srgb: return "srgb";
    case Kind::bt709: return "bt709";
    case Kind::linear: return "linear";
    case Kind::gamma: return format("gamma:{}", exponent_);
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
  }
  return light;
}

std::optional<Transfer::Toe> Transfer::toe() const {
  switch (kind_) {
    case Kind::srgb: return Toe{kSrgbToeFraction, 1.0 / kSrgbToeSlope};
    case Kind::bt709: return Toe{kBt709ToeSlope * kBt709ToeLight, 1.0 / kBt709ToeSlope};
    case Kind::linear:
    case Kind::gamma: return std::nullopt;
  }
  return std::nullopt;
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
