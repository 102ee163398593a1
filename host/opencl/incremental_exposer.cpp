#include "opencl/incremental_exposer.hpp"

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

void IncrementalExposer::clear() {
  kept_.clear();
  last_.clear();
}

void IncrementalExposer::expose(const Means& means, const RenderPlan& plan, const CaptureSource& source,
                                Precision precision, const RenderMemory& shares, std::span<ExposedBand> bands,
                                const Exposer::Develop& develop) {
  const std::vector<std::uint8_t> exposes = last_.take(plan, precision, bands);
  means.statistics.exposed_functions = static_cast<std::uint64_t>(std::ranges::count(exposes, 1));
  const SumsInUse kept = sums_in_use(means, plan, source, precision, shares.kept_bytes, exposes, bands);
  means.statistics.kept_sums += kept.entries.size();
  std::uint64_t bytes = 0;
  for (const ExposedBand& each : bands) {
    bytes += sums_bytes(each.band.sum_tiles, plan.capture.shape.channels, precision);
  }
  const bool holds = bytes <= shares.held_bytes;
  means.expose({plan, kept, exposes}, bands, [&](const ExposedBand& exposed) {
    develop(exposed);
    if (holds) last_.hold(exposed);
  });
  if (holds) last_.complete(plan, precision);
}

// Some of which it makes first.
SumsInUse IncrementalExposer::sums_in_use(const Means& means, const RenderPlan& plan,
                                          const CaptureSource& source, Precision precision,
                                          std::uint64_t max_bytes, std::span<const std::uint8_t> exposes,
                                          std::span<const ExposedBand> bands) {
  KeptSums& kept = kept_[precision];
  for (const SummedBlocks& blocks : kept.worth_making(plan, exposes, precision, max_bytes, means.info)) {
    const RenderPlan& of_light = kept.plan_for(blocks, plan, source);
    const std::size_t slot = kept.slot_for(means.memory);
    const DeviceMemory::Scope scope(means.memory);
    std::vector<ExposedBand> all = means.whole_picture(of_light);
    const std::vector<std::uint8_t> every = every_function(of_light);
    means.expose({of_light, kept.in_use(of_light, every, all), every}, all,
                 [&](const ExposedBand& exposed) { kept.store(slot, exposed, means.queue); });
    kept.keep(slot, blocks);
    ++means.statistics.made_sums;
  }
  means.memory.count(kept.bytes());
  return kept.in_use(plan, exposes, bands);
}

}  // namespace nutik
