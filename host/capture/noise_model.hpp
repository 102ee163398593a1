// What counts as a change, and how far a camera's codes stray where nothing changes.
//
// A camera's noise is a standard deviation in codes for every code, channel by channel:
//
//   sensor   sd² = slope² · (read² + shot · L) + 1/12, L being the light of the code: noise of reading, which
//            is always there, and shot noise, whose variance grows with the light, through the slope of
//            the transfer function at L; and rounding to whole codes
//   points   straight lines between points that were measured, the outermost held: for cameras, and
//            compressed clips, that do not behave like a sensor
//
// docs/explanation/noise.md derives it; capture/noise_file.hpp has it as text.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "capture/transfer.hpp"

namespace nutik {

// What rounding to whole codes adds, in codes².
inline constexpr double kRoundingVariance = 1.0 / 12.0;

// Where noise was measured: pixels whose expected value is about `code` have a standard deviation of `sd`
// codes over time.
struct NoisePoint {
  double code = 0;
  double sd = 0;
  std::uint64_t pixels = 0;  // that it was measured on

  friend bool operator==(const NoisePoint&, const NoisePoint&) = default;
};

enum class NoiseCurve { sensor, points };

[[nodiscard]] std::string_view to_text(NoiseCurve curve);

struct ChannelNoise {
  NoiseCurve curve = NoiseCurve::sensor;  // which of the two is used
  double read = 0;                        // standard deviation in light where there is none
  double shot = 0;                        // variance in light for each unit of light
  std::vector<NoisePoint> points;         // codes increase; at least one where the curve is `points`

  friend bool operator==(const ChannelNoise&, const ChannelNoise&) = default;
};

struct CameraNoise {
  std::uint32_t white_code = 255;
  Transfer transfer = Transfer::srgb();
  std::vector<ChannelNoise> channels;  // 1 or 3

  // Standard deviation in codes at a code 0 … white_code, by the channel's curve. Above 0.
  [[nodiscard]] double sd(std::uint32_t channel, double code) const;

  // The same for every code 0 … white_code.
  [[nodiscard]] std::vector<float> sd_of_codes(std::uint32_t channel) const;

  friend bool operator==(const CameraNoise&, const CameraNoise&) = default;
};

// Standard deviation in codes at `code` that noise of `light_sd` in light comes to, rounding included; and
// the light_sd that comes to a given one (0 where that is less than rounding alone).
//
// The slope of the transfer function is taken over one standard deviation to either side, the function being
// continued as an odd one below 0: where it bends within the noise this is what the noise really meets.
[[nodiscard]] double code_sd_of(double light_sd, double code, std::uint32_t white_code,
                                const Transfer& transfer);
[[nodiscard]] double light_sd_of(double code_sd, double code, std::uint32_t white_code,
                                 const Transfer& transfer);

// A record is written when a pixel leaves what it holds by more than this in any channel: more than
// `tolerance` codes, 0 keeping every change (lossless); or, where the camera's noise is known, more than
// `sigmas` standard deviations. The tolerance is 0 then.
struct NoiseModel {
  static constexpr double kDefaultSigmas = 3.0;

  std::uint32_t tolerance = 0;  // codes
  std::optional<CameraNoise> camera;
  double sigmas = kDefaultSigmas;

  [[nodiscard]] bool is_lossless() const { return tolerance == 0 && !camera; }
  friend bool operator==(const NoiseModel&, const NoiseModel&) = default;
};

}  // namespace nutik
