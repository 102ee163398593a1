// A few consecutive samples of a still scene, and how much each pixel strays in them.
//
//   in:      up to kWindowSamples samples as interleaved rasters
//   out:     for each channel, each pixel's mean and variance over time, in codes
//   always:  what all pixels do together, an offset and a gain from sample to sample, is flicker and taken out.
//            Variances are those of second differences in time, so that whatever goes on evenly, as slow motion
//            and changing daylight do, is no noise. Large pictures are thinned out
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "capture/picture.hpp"

namespace nutik {

// Long enough that a pixel's variance is known to a half, short enough that little moves.
inline constexpr std::uint32_t kWindowSamples = 16;
inline constexpr std::uint32_t kMinWindowSamples = 3;  // of a second difference

// Noise of neighbours is a pixel's own; what lies further apart than what a camera makes of a mosaic reaches has
// nothing in common, unless something moves.
inline constexpr std::uint32_t kNeighbourPixels = 4;

struct PixelNoise {
  float code = 0;      // mean
  float variance = 0;  // codes²
  // Covariances with the pixel that lies kNeighbourPixels to the right, and below: 0 where there is none.
  float beside = 0;
  float below = 0;
  // The last bits of its row's and its column's number: a sensor's mosaic leaves interpolated values, which stray less
  // than the measured ones beside them.
  std::uint32_t place = 0;
};
inline constexpr std::size_t kMosaicPlaces = 4;

class StillWindow {
 public:
  explicit StillWindow(const CaptureFormat& capture);

  // Pixels that are looked at.
  [[nodiscard]] static std::uint64_t pixel_count(const Shape& shape);
  // What a window takes, and what measuring takes besides for each channel that is measured at a time.
  [[nodiscard]] static std::uint64_t window_bytes(const Shape& shape);
  [[nodiscard]] static std::uint64_t measuring_bytes(const Shape& shape);

  // Adds a sample of CaptureFormat::sample_bytes(); the window must not be full.
  void add(std::span<const std::byte> raster);

  [[nodiscard]] std::uint32_t sample_count() const { return samples_; }
  [[nodiscard]] bool is_full() const { return samples_ == kWindowSamples; }

  // One entry for every pixel of a channel. At least kMinWindowSamples samples are there.
  [[nodiscard]] std::vector<PixelNoise> measure(std::uint32_t channel) const;

  // The degrees of freedom of a variance that was measured on so many samples.
  [[nodiscard]] static double degrees_of_freedom(std::uint32_t samples);

  void clear() { samples_ = 0; }

 private:
  template <typename Code>
  void add(const Code* raster);

  // Sample k of a pixel whose mean is m is too large by offset + gain · m.
  struct Flicker {
    double offset = 0;
    double gain = 0;
  };

  [[nodiscard]] const std::uint16_t* plane(std::uint32_t sample, std::uint32_t channel) const {
    return codes_.data() + (std::size_t{sample} * format_.shape.channels + channel) * pixels_.size();
  }
  [[nodiscard]] Flicker flicker(const std::uint16_t* codes, std::span<const float> means) const;

  CaptureFormat format_;
  std::vector<std::uint64_t> pixels_;  // that are looked at, row-major
  std::vector<std::uint16_t> codes_;   // [sample][channel][pixel looked at]
  std::size_t columns_ = 0;            // of these
  std::size_t neighbour_ = 1;          // how many of them are kNeighbourPixels
  std::uint32_t samples_ = 0;
};

}  // namespace nutik
