// How far a capture is from the samples it was made from.
//
//   in:      the capture's blocks in order, each with the source's samples of it
//   out:     worst and mean error in codes of the source, and how many samples are beyond the noise's band
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "capture/picture.hpp"
#include "imev/block.hpp"

namespace nutik {

class SourceComparison {
 public:
  // `source` is what was encoded, with its noise model.
  explicit SourceComparison(const CaptureFormat& source);

  // In time order: sample `sample` of `block`, whose format is held_format(source), and the source's raster of it,
  // empty where nobody filmed it.
  void add(const BlockView& block, std::uint32_t sample, std::span<const std::byte> raster);

  struct Worst {
    double error = 0;  // codes of the source
    std::uint64_t sample = 0;
    std::uint64_t pixel = 0;  // row-major
  };
  [[nodiscard]] const Worst& worst() const { return worst_; }
  // Values further from what is held than the tolerance, or the noise's band, permits. Always 0 but for a fault.
  [[nodiscard]] std::uint64_t values_beyond() const { return values_beyond_; }
  [[nodiscard]] std::uint64_t value_count() const { return value_count_; }
  // Change records that the capture keeps.
  [[nodiscard]] std::uint64_t record_count() const { return record_count_; }
  // Peak signal to noise in decibels, the peak being white; infinite where nothing differs.
  [[nodiscard]] double psnr() const;

 private:
  CaptureFormat source_;
  std::uint32_t scale_;
  std::vector<std::vector<double>> bands_;  // [channel][held code], in codes of the source
  std::vector<std::byte> held_, before_;  // of the sample before
  Worst worst_;
  double squares_ = 0;
  std::uint64_t values_beyond_ = 0;
  std::uint64_t value_count_ = 0;
  std::uint64_t record_count_ = 0;
};

}  // namespace nutik
