// What happens to a tile of every sample: its codes are moved from the interleaved raster to planes, and the
// lanes found that differ from what they hold.
#pragma once

#include <cstddef>
#include <cstdint>

#include "capture/picture.hpp"
#include "imev/tile.hpp"

namespace nutik {

// A whole tile within a raster of CaptureFormat's codes; `row_values` is the number of values from one raster
// row to the next.
struct TileRaster {
  const std::byte* codes;
  std::size_t row_values;
};

// What a tile of a sample is compared with, and what its changes are counted in.
struct TileStep {
  TileRaster raster;
  std::uint32_t tolerance;
  std::byte* held;        // codes[channel][lane]; those that change are replaced
  std::uint16_t* counts;  // change records of every lane; null where the change is none
};

// Returns the lanes, as bits, in which any channel is further than the tolerance from what is held.
using StepFunction = std::uint64_t (*)(const TileStep&);
[[nodiscard]] StepFunction step_function(const CaptureFormat& capture);

// Writes codes[channel][lane].
using GatherFunction = void (*)(const TileRaster& raster, std::byte* codes);
[[nodiscard]] GatherFunction gather_function(const CaptureFormat& capture);

}  // namespace nutik
