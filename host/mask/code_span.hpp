// How far the codes of each pixel lie apart within a part of a capture: what tells motion from stillness.
//
// A pixel's span is its largest code less its smallest, of the channel where that is most. Unlike the number
// of its changes it does not grow with the noise of ever more samples, and a slow edge, each of whose steps
// is small, spans as much as a fast one.
//
//   in:      blocks of a capture; spans; pictures
//   out:     a number of codes for each pixel, and regions by it
//   always:  memory for two codes of each value, however many samples there are
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "capture/picture.hpp"
#include "imev/block.hpp"
#include "mask/region.hpp"

namespace nutik {

class CodeSpan {
 public:
  // The samples are [first, last).
  CodeSpan(const CaptureFormat& capture, SampleRange samples);

  // Adds what a block holds of those samples; blocks in any order. Throws InputError where it is damaged.
  void add(const BlockView& block);

  // Every pixel's span in codes, row by row, once all blocks have been added that hold any of the samples.
  [[nodiscard]] std::vector<std::uint32_t> spans() const;

 private:
  CaptureFormat capture_;
  SampleRange samples_;
  std::vector<std::uint16_t> min_;  // interleaved
  std::vector<std::uint16_t> max_;
};

// The largest difference of a pixel in two pictures of one shape and white code, of all channels: its span
// where the pictures are all there is.
[[nodiscard]] std::vector<std::uint32_t> differences(const Picture& a, const Picture& b);

// Up to which span a pixel is taken to be still: twice what a quarter of all pixels do not pass, for most
// scenes are still in a quarter at least and what happens there is noise; and no less than 1/16 of white. Where that
// comes near white, or above it, half way from the quarter's span to white: below white, which no span passes.
[[nodiscard]] std::uint32_t default_noise(std::vector<std::uint32_t> spans, std::uint32_t white_code);

// The pixels whose span is more than `codes`.
[[nodiscard]] Region spanning_more(const Shape& shape, std::span<const std::uint32_t> spans,
                                   std::uint32_t codes);

// The pixels of a picture of codes whose brightness lies in [low, high], in codes: the code of a grey pixel,
// the luma of a colour one (ITU-R BT.709, of codes as they are).
[[nodiscard]] Region between(const Picture& picture, double low, double high);

}  // namespace nutik
