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

#include "render/render_plan.hpp"

namespace nutik {

struct FixedScale {
  // What light 1 is: the white code where light is the code itself, else 2^light_bits.
  std::uint64_t white_light = 1;
  int light_bits = 0;
  std::vector<int> exponents;  // by planned function

  // Where lights are blended, 1 is white_light · 2^(kCodeBits − light_bits − blend_shift): no light of the plan leaves
  // [-2^kBlendBits, 2^kBlendBits] there, so that shares of it add up within 63 bits.
  int blend_shift = 0;

  // A sum of light · weight as light: sum · light_factor(f), in scaled gain (GainSummary::exponent).
  [[nodiscard]] double light_factor(std::size_t function) const;
};

// What light 1 is where codes are made of it, at most: 2^kCodeBits. Leaves room for a sum that is larger.
inline constexpr int kCodeBits = 61;
inline constexpr int kBlendBits = 46;

[[nodiscard]] FixedScale fixed_scale(const RenderPlan& plan);

// A function's numbers of one block as whole numbers: of the samples that it needs, and one boundary more. A weight is
// the difference of two boundaries that were rounded before, each of them from the weights of the whole capture up to
// there; boundaries start with 0 in each block.
struct FixedBlock {
  std::vector<std::int64_t> weights;
  std::vector<std::int64_t> boundaries;
};

// Blocks may be asked for in any order.
[[nodiscard]] FixedBlock fixed_block(const BlockTable& table, int exponent);

}  // namespace nutik
