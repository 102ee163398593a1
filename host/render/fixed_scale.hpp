// How exposures are put into whole numbers of 64 bits.
//
//   in:      a plan
//   out:     light as a whole number of 0 … white_light; per function the exponent of 2 by which its boundaries
//            are multiplied before they are rounded, once for the whole capture
//   always:  no sum of white_light · weights leaves [-2^62, 2^62], in any order, whatever the codes; the
//            result depends on the functions and the timeline alone, not on blocks or tiles
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "exposure/compensated_sum.hpp"
#include "render/render_plan.hpp"

namespace nutik {

struct FixedScale {
  // What light 1 is: the white code where light is the code itself, else 2^light_bits.
  std::uint64_t white_light = 1;
  int light_bits = 0;
  std::vector<int> exponents;  // by planned function

  // A sum of light · weight as light: sum · light_factor(f), in scaled gain (GainSummary::exponent).
  [[nodiscard]] double light_factor(std::size_t function) const;
};

[[nodiscard]] FixedScale fixed_scale(const RenderPlan& plan);

// The plan's tables as whole numbers: [row][function] like RenderPlan::weights and boundaries. A weight is the
// difference of two boundaries that were rounded before; boundaries start with 0 in each block.
struct FixedTables {
  std::vector<std::int64_t> weights;
  std::vector<std::int64_t> boundaries;
};

// Rounds a plan's tables from its first block to its last, in as many parts as wanted: the same numbers always.
class FixedSweep {
 public:
  // The plan must live as long.
  FixedSweep(const RenderPlan& plan, const FixedScale& scale);

  // The rows of the planned blocks from where the last part ended up to `last_block`, which is not part of it.
  [[nodiscard]] FixedTables pack(std::size_t last_block);

 private:
  // What a function's weights so far add up to.
  struct Boundary {
    CompensatedSum exact;
    std::int64_t rounded = 0;
  };

  const RenderPlan& plan_;
  std::vector<int> exponents_;
  std::vector<Boundary> boundaries_;
  std::size_t next_block_ = 0;
};

}  // namespace nutik
