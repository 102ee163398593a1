// What happens to the tiles of every sample: their codes are moved from the interleaved raster to planes, and the
// lanes found that differ from what they hold.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "capture/picture.hpp"
#include "capture/pixel_change.hpp"
#include "imev/tile.hpp"

namespace nutik {

// With a tolerance of T codes, what is held moves by whole steps of 2 T + 1 to the one that is nearest to the new code,
// but not beyond 0 and white: no further from it than T, and codecs keep a number of steps.
struct CodeSteps {
  // Up to here a number of two bytes times a step has four.
  static constexpr std::int32_t kLargest = (1 << 15) - 1;

  std::int32_t codes = 1;  // 1: what is held is the new code
  std::int32_t white = 0;

  [[nodiscard]] static CodeSteps of(const CaptureFormat& capture) {
    return {
        static_cast<std::int32_t>(std::min<std::uint64_t>(2 * std::uint64_t{capture.noise.tolerance} + 1, 1u << 17)),
        static_cast<std::int32_t>(capture.white_code)};
  }
  [[nodiscard]] std::int32_t moved(std::int32_t held, std::int32_t count) const {
    return std::clamp(held + count * codes, 0, white);
  }
  // How many lead to a code, where `rest` of a step counts as one more: exact, for distances have 17 bits.
  [[nodiscard]] std::int32_t count(std::int32_t held, std::int32_t code, std::int32_t rest) const {
    const std::int32_t distance = code - held, sign = distance >> 31;
    const float whole = (static_cast<float>((distance ^ sign) - sign) + static_cast<float>(codes - rest) + 0.5F) *
                        (1.0F / static_cast<float>(codes));
    return (static_cast<std::int32_t>(whole) ^ sign) - sign;
  }
  [[nodiscard]] std::int32_t nearest_count(std::int32_t held, std::int32_t code) const {
    return count(held, code, codes / 2 + 1);
  }
  // What is held from a code on.
  [[nodiscard]] std::int32_t nearest(std::int32_t held, std::int32_t code) const {
    return moved(held, nearest_count(held, code));
  }
};

// A tile's row that is told by what changes in it. Rows are codes[channel][lane].

// Into all lanes that show the pixel: its own, and those outside the picture that repeat it. `row` is of the tile that
// the pixel is in.
void write_change(const CaptureFormat& capture, const PixelChange& change, std::byte* row);

// The lanes, as bits, in which any channel is further from what is held than the capture's tolerance. They are given
// what is held from now on, the others what is held.
[[nodiscard]] std::uint64_t differing_lanes(const CaptureFormat& capture, const std::byte* held,
                                            std::byte* row);

// A whole tile within a raster of CaptureFormat's codes; `row_values` is the number of values from one raster
// row to the next.
struct TileRaster {
  const std::byte* codes;
  std::size_t row_values;
};

// Neighbours in a row of tiles take the step together, several samples at a time: what is held stays in the
// cache from one to the next, rows are written in runs, and no plane is read right after it was written in
// smaller pieces, which processors have to wait for.
inline constexpr std::uint32_t kStripTiles = 8;
inline constexpr std::uint32_t kStepSamples = 4;

struct StripStep {
  std::array<const std::byte*, kStepSamples> rasters;  // in each sample, of the first tile
  std::size_t row_values;
  std::uint32_t sample_count;
  std::uint32_t tile_count;
  std::uint32_t tolerance;
  CodeSteps steps;
  bool writes_all;  // also rows in which nothing changed
  std::array<const std::byte*, kStripTiles>
      held;                                  // in: what each tile holds, codes[channel][lane]; may be next
  std::array<std::byte*, kStripTiles> next;  // out: what it holds from each sample on that is written

  // out: the lanes, as bits, in which any channel was further than the tolerance from what was held.
  std::array<std::array<std::uint64_t, kStripTiles>, kStepSamples> changes;
  std::array<std::uint32_t, kStripTiles>
      change_counts;  // out: how many lanes they are in all samples together
};
using StepFunction = void (*)(StripStep&);
[[nodiscard]] StepFunction step_function(const CaptureFormat& capture);

// Writes codes[channel][lane].
using GatherFunction = void (*)(const TileRaster& raster, std::byte* codes);
[[nodiscard]] GatherFunction gather_function(const CaptureFormat& capture);

// The lanes, as bits, in which two rows of codes[channel][lane] differ.
using DifferFunction = std::uint64_t (*)(const std::byte* a, const std::byte* b);
[[nodiscard]] DifferFunction differ_function(std::uint32_t channels, std::uint32_t code_bytes);

}  // namespace nutik
