#include "opencl/last_exposure.hpp"

#include <algorithm>
#include <utility>

namespace nutik {

std::vector<std::uint8_t> LastExposure::take(const RenderPlan& plan, Precision precision,
                                             std::span<ExposedBand> bands) {
  made_.clear();
  const std::vector<Held> held = std::exchange(held_, {});
  const std::vector<TableColumnSource> functions = column_sources(plan, precision);
  std::vector<std::uint8_t> exposes(functions.size(), 1);
  const auto is_same = [](const Held& before, const ExposedBand& now) {
    return before.band == now.band && before.map == now.map.map;
  };
  if (precision != precision_ || plan.capture.transfer != transfer_ ||
      functions.size() != functions_.size() || !std::ranges::equal(held, bands, is_same)) {
    return exposes;
  }
  for (std::size_t b = 0; b < bands.size(); ++b) bands[b].sums = held[b].sums;
  for (std::size_t f = 0; f < functions.size(); ++f) exposes[f] = functions[f] != functions_[f];
  return exposes;
}

void LastExposure::complete(const RenderPlan& plan, Precision precision) {
  held_ = std::exchange(made_, {});
  functions_ = column_sources(plan, precision);
  precision_ = precision;
  transfer_ = plan.capture.transfer;
}

}  // namespace nutik
