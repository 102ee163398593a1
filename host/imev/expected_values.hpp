// Finds what noisy samples stand for: the light that a pixel is expected to have, and when that changes.
//
//   in:      the samples of one tile over a block, and the camera's noise (capture/noise_model.hpp)
//   out:     the codes held at each of them, and which lanes change with which sample
//   always:  a sample lies within `sigmas` standard deviations (those at the held code) of what is held, in
//            every channel; codes that are held are the mean, in light, of the samples they stand for, so
//            that an exposure of them all is what it would be of the samples themselves; a sample that
//            stands for itself is held exactly
//
// A pixel's samples are first cut where its level changes: at the sample where the means of what lies before
// and behind differ most for their noise, if that is more than kCutShare · sigmas standard deviations of
// the difference; and so on in both parts. That finds edges where they are, and slow ramps become steps
// long before a sample leaves the band. Then samples outside the band of their level stand for themselves,
// and the level goes on behind them; so it does behind a level of one or two samples only, where it is the
// same as before: a false alarm, or a spark, costs two records and no precision.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "capture/picture.hpp"

namespace nutik {

// The format of what is held where samples of the format `source` are encoded. Without a camera's noise it is
// the same. With it means need more bits: codes have 16 bits, and white is as large as it can be so that
// each code of the source is a multiple of one whole number (257 for 8 bits, 16 for 12).
[[nodiscard]] CaptureFormat held_format(const CaptureFormat& source);

// What a code of the source is multiplied by to be a code of held_format(source).
[[nodiscard]] std::uint32_t held_scale(const CaptureFormat& source);

// A raster of source codes in codes of held_format(source).
[[nodiscard]] std::vector<std::byte> to_held_codes(const CaptureFormat& source,
                                                   std::span<const std::byte> raster);

class ExpectedValues {
 public:
  static constexpr double kCutShare = 1.5;

  // Throws UsageError where the noise was measured on another number of channels or with another white code.
  explicit ExpectedValues(const CaptureFormat& source);

  // What a tile holds: codes of held_format() for every sample, and the lanes, as bits, that hold others than
  // at the sample before (none at the first).
  struct Held {
    std::vector<std::uint16_t> codes;    // [sample][C][64]
    std::vector<std::uint64_t> changes;  // [sample]
  };

  // `codes` are the source's [sample][C][64]. `held` is replaced. May be called by several threads at once.
  void find(const std::byte* codes, std::uint32_t samples, Held& held) const;

 private:
  template <typename Code>
  class Pixel;

  template <typename Code>
  void find_in(const Code* codes, std::uint32_t samples, Held& held) const;

  std::uint32_t channels_;
  std::uint32_t code_bytes_;
  std::uint32_t white_code_;  // of the source
  std::uint32_t scale_;
  double sigmas_;
  Transfer transfer_;
  std::vector<double> light_;                // [code]
  std::vector<std::vector<float>> sd_;       // [channel][code] in codes of the source
  std::vector<std::vector<float>> held_sd_;  // [channel][code of held_format()] in codes of the source
};

}  // namespace nutik
