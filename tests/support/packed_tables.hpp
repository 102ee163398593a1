// The tables of a plan's functions side by side, as kernels read them: [row][function].
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "render/fixed_scale.hpp"
#include "render/render_plan.hpp"

namespace nutik::test {

template <typename Number>
struct PackedTables {
  std::vector<Number> weights;
  std::vector<Number> boundaries;
};

// For the planned blocks [first, last). `numbers_of(function, BlockTable)` gives weights and boundaries of the samples
// that the function needs.
template <typename Number, typename NumbersOf>
PackedTables<Number> packed(const RenderPlan& plan, std::size_t first, std::size_t last,
                            NumbersOf numbers_of) {
  const std::uint64_t count = plan.function_count();
  PackedTables<Number> tables;
  for (std::size_t b = first; b < last; ++b) {
    const PlannedBlock& block = plan.blocks[b];
    const std::size_t begin = tables.weights.size();
    tables.weights.resize(begin + block.row_count() * count);
    tables.boundaries.resize(tables.weights.size());
    for (std::size_t f = 0; f < count; ++f) {
      GainTable::Reader reader(*plan.functions[f].table);
      const BlockTable of_block = reader.block(block.block);
      const auto numbers = numbers_of(f, of_block);
      for (std::uint64_t row = 0; row < block.row_count() && !of_block.span.empty(); ++row) {
        const std::size_t at = begin + row * count + f;
        const std::uint64_t k = std::clamp<std::uint64_t>(row, of_block.span.first, of_block.span.last);
        if (row == k && k < of_block.span.last) tables.weights[at] = numbers.weights[k - of_block.span.first];
        tables.boundaries[at] = numbers.boundaries[k - of_block.span.first];
      }
    }
  }
  return tables;
}

inline PackedTables<double> packed_tables(const RenderPlan& plan) {
  return packed<double>(plan, 0, plan.blocks.size(),
                        [](std::size_t, const BlockTable& table) { return table; });
}

inline PackedTables<std::int64_t> fixed_tables(const RenderPlan& plan, const FixedScale& scale,
                                               std::size_t first, std::size_t last) {
  return packed<std::int64_t>(plan, first, last, [&](std::size_t f, const BlockTable& table) {
    return fixed_block(table, scale.exponents[f]);
  });
}

inline PackedTables<std::int64_t> fixed_tables(const RenderPlan& plan, const FixedScale& scale) {
  return fixed_tables(plan, scale, 0, plan.blocks.size());
}

}  // namespace nutik::test
