// Finds out whether a clip stands still where it seems to: whether what its pixels stray by is noise alone.
//
//   in:      samples of a clip, and the noise that was measured on it
//   out:     by how much the light of pixels that do not visibly change strays around its mean over a stretch of
//            samples, which is what a capture with a noise model holds for them; and where, and when
//   always:  noise of a sensor is another at each sample and at each pixel. So in it means of many samples differ
//            by no more than means of few do for their number, and pixels apart from each other by nothing in common.
//            Neither depends on how much noise there is, how it is distributed or how codes are rounded
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "capture/noise_model.hpp"
#include "capture/picture.hpp"

namespace nutik {

// Samples that are looked at together: as many as a block of a capture has.
inline constexpr std::uint64_t kStretchSamples = 64;

struct Stillness {
  // What light strays by, as a share of the noise's standard deviation: over the picture, and where it strays most.
  // Samples count in which a pixel does not visibly change; what does is held for itself.
  double stray = 0;
  double limit = 0;  // of it
  // Whether most of what pixels stray and change by is common to all of them: brightness, and no movement.
  bool is_brightness = false;

  double max_stray = 0;   // of one region
  double max_limit = 0;   // of it
  double stray_share = 0;  // of the regions: those that stray by more than their limit
  Rectangle region;        // that strays most
  std::uint64_t first_sample = 0, last_sample = 0;  // of the stretch in which most strays
};

class StillnessWatch {
 public:
  // Light that is held is off by a fifth of the noise's standard deviation where all stands still (imev_tests,
  // docs/explanation/noise.md); what is no noise may add as much.
  static constexpr double kMaxStray = 0.2;

  StillnessWatch(const CaptureFormat& capture, std::uint64_t max_samples);

  [[nodiscard]] static std::uint64_t bytes(const Shape& shape, std::uint64_t max_samples);

  // Adds a sample of CaptureFormat::sample_bytes(); those beyond `max_samples` are left out.
  void add(std::span<const std::byte> raster);

  // Needs at least three samples, and the noise that was measured on them.
  [[nodiscard]] Stillness judge(const CameraNoise& noise) const;

 private:
  class Stretch;
  struct Sums;

  [[nodiscard]] Stillness judge(const CameraNoise& noise, std::uint32_t channel) const;
  [[nodiscard]] const std::uint16_t* plane(std::uint64_t sample, std::uint32_t channel) const {
    return codes_.data() + (sample * format_.shape.channels + channel) * pixels_.size();
  }

  CaptureFormat format_;
  std::uint64_t max_samples_;
  std::uint64_t samples_ = 0;
  std::uint32_t regions_;              // in a row, and in a column
  std::vector<std::uint64_t> pixels_;  // that are looked at, row-major
  std::vector<std::uint32_t>
      beside_;  // the one kNeighbourPixels to the right, as an index; itself where none is
  std::vector<std::uint32_t> below_;   // the one kNeighbourPixels below
  std::vector<std::uint32_t> region_;  // that a pixel lies in
  std::vector<std::uint16_t> codes_;   // [sample][channel][pixel looked at]
};

}  // namespace nutik
