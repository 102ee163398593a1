#include "session/exposed_picture.hpp"

#include <utility>

namespace nutik {

ExposureFigures ExposureFigures::of(RenderPlan&& plan, const Timeline& timeline,
                                    std::optional<std::uint64_t> block_count) {
  ExposureFigures figures{plan.capture, timeline, {}, plan.exposed_sample_count(), {}, plan.blocks.size(),
                          block_count,  0,        0};
  if (!plan.blocks.empty()) {
    figures.read = {plan.blocks.front().extent.range().first, plan.blocks.back().extent.range().last};
  }
  figures.table_bytes = 2 * plan.row_count() * plan.function_count() * sizeof(double);
  figures.map_bytes = plan.map->region_of_pixel.size();
  figures.functions = std::move(plan.functions);
  for (PlannedFunction& function : figures.functions) function.table.reset();  // its memory is the session's
  return figures;
}

}  // namespace nutik
