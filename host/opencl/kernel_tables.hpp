// What the kernels read and write beside the capture, in the arithmetic of a precision: the host's side of
// kernels/floating.clh, compensated.clh and fixed.clh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "opencl/allocation_cuts.hpp"
#include "opencl/light_source.hpp"
#include "render/fixed_scale.hpp"
#include "render/output_format.hpp"
#include "render/precision.hpp"

namespace nutik {

using Bytes = std::vector<std::byte>;

// Of a pixel's sum in one channel, all its planes.
inline constexpr std::size_t sum_bytes(Precision precision) {
  return precision == Precision::single_ ? 4 : 8;
}

// Of one weight or boundary: as wide as the sums that it goes into.
inline constexpr std::size_t weight_bytes(Precision precision) { return sum_bytes(precision); }

struct WeightTables {
  Bytes weights;     // Weight [row][function]
  Bytes boundaries;  // likewise
};

// The tables that a plan is exposed with.
class ExposureTables {
 public:
  // The plan must live as long.
  ExposureTables(const RenderPlan& plan, Precision precision);

  // The rows of a slice. Slices are asked for in time order, each once.
  [[nodiscard]] WeightTables pack(const TableSlice& slice);
  // Light of every code, or a curve.
  [[nodiscard]] Bytes light(const LightSource& light) const;

 private:
  const RenderPlan& plan_;
  Precision precision_;
  FixedScale scale_;  // of whole numbers
  FixedSweep sweep_;  // likewise
};

struct CodeTables {
  Bytes scales;  // LightScale [function]
  Bytes
      thresholds;  // Threshold: what white is, the least light of code 1 … white code, then more than any light
  std::vector<std::uint32_t> guesses;
};
// Throws UsageError where the codes lie too close together (code_search.hpp).
[[nodiscard]] CodeTables code_tables(const RenderPlan& plan, Precision precision, std::uint32_t white_code);

// The light of `raster`, sums [pixel][channel][plane] of a rectangle as develop_sums writes them, into a picture of
// light32 or light64. Done by the host in double, so that it is the same for every device.
void store_light(const RenderPlan& plan, const Rectangle& rectangle, Precision precision,
                 std::span<const std::byte> raster, Picture& picture);

}  // namespace nutik
