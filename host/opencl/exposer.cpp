#include "opencl/exposer.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "opencl/needed_tiles.hpp"
#include "opencl/opencl_api.hpp"
#include "system/mapped_file.hpp"

namespace nutik {
namespace {

// A chunk's blocks, cut so that no launch reads more samples, but one block at least.
std::vector<std::span<const BlockEntry>> launches_of(std::span<const BlockEntry> entries,
                                                     std::uint64_t max_samples) {
  std::vector<std::span<const BlockEntry>> launches;
  std::size_t first = 0;
  std::uint64_t samples = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::uint32_t read = std::max(entries[i].sample_count, 1u);  // a kept sum is as much
    if (i > first && samples + read > max_samples) {
      launches.push_back(entries.subspan(first, i - first));
      first = i;
      samples = 0;
    }
    samples += read;
  }
  launches.push_back(entries.subspan(first));
  return launches;
}

}  // namespace

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
  SumsInUse kept = sums_in_use(means, plan, source, precision, shares.kept_bytes, exposes, bands);
  means.statistics.kept_sums += kept.entries.size();
  std::uint64_t bytes = 0;
  for (const ExposedBand& each : bands) {
    bytes += sums_bytes(each.band.sum_tiles, plan.capture.shape.channels, precision);
  }
  const bool holds = bytes <= shares.held_bytes;
  means.expose({plan, std::move(kept), exposes}, bands, [&](const ExposedBand& exposed) {
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
  for (const SummedBlocks& blocks : kept.begin_exposure(plan, exposes, precision, max_bytes, means.info)) {
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

void Exposer::expose(std::span<ExposedBand> bands, const RenderControl& control, const Develop& develop) {
  const NeededTiles tiles(plan_, bands);
  device_.feed.start(plan_, kernel_.slices, source_, tiles, shares_.feed, kept_.skipped);
  // Nothing is read from a capture any more when its exposure ends, however it does.
  const std::unique_ptr<BlockFeed, decltype([](BlockFeed* feed) { feed->stop(); })> stopped(&device_.feed);
  const DeviceMemory::Scope scope(memory_);
  const bool has_bundles =
      work_.precision != Precision::fixed && plan_.combine == Combine::integral && plan_.has_bundles();
  // Tables of several slices would have to be written anew for each band.
  const bool are_all_there = bands.size() > 1 && kernel_.slices.size() == 1 && fetch_all();
  const std::size_t bands_at_once = are_all_there ? 1 : bands.size();
  to_read_ = read_blocks(0, plan_.blocks.size()) * ((bands.size() + bands_at_once - 1) / bands_at_once);
  for (std::size_t first = 0; first < bands.size(); first += bands_at_once) {
    const std::span<ExposedBand> exposed = bands.subspan(first, bands_at_once);
    const DeviceMemory::Scope sums_scope(memory_);
    for (ExposedBand& each : exposed) {
      const std::uint64_t bytes =
          sums_bytes(each.band.sum_tiles, plan_.capture.shape.channels, work_.precision);
      if (each.sums() == nullptr) {
        each.sums = memory_.allocate(bytes, CL_MEM_READ_WRITE);
      } else {
        memory_.count(bytes);
      }
      each.bundles = has_bundles ? memory_.allocate(bytes, CL_MEM_READ_WRITE) : each.sums;
    }
    sum_up(exposed, control);
    throw_if_cancelled(control);
    memory_.count(device_.feed.bytes());
    for (ExposedBand& each : exposed) {
      develop(each);
      each.sums = {};
      each.bundles = {};
    }
  }
}

bool Exposer::fetch_all() {
  std::uint64_t bytes = 0;
  const std::size_t all_blocks = read_blocks(0, plan_.blocks.size());
  for (std::size_t blocks = 0; blocks < all_blocks;) {
    const BlockFeed::Chunk& chunk = fetched_.emplace_back(next_chunk());
    blocks += chunk.entries.size();
    memory_.count(chunk.host_bytes);
    bytes += chunk.payload_bytes;
    // More than may stay is more than the system may hold of a file: each band would read it again.
    if (!chunk.stays || bytes > shares_.feed.resident_bytes) return blocks == all_blocks && chunk.stays;
  }
  return true;
}

std::size_t Exposer::read_blocks(std::size_t first, std::size_t last) const {
  if (kept_.skipped.empty()) return last - first;
  const auto skipped = kept_.skipped.begin();
  return static_cast<std::size_t>(std::count(skipped + static_cast<std::ptrdiff_t>(first),
                                             skipped + static_cast<std::ptrdiff_t>(last), false));
}

void Exposer::add_kept(const TableSlice& slice, std::size_t last, std::size_t& next,
                       std::vector<BlockEntry>& entries) const {
  for (; next < kept_.entries.size() && kept_.entries[next].planned <= last; ++next) {
    const SumsInUse::Entry& kept = kept_.entries[next];
    entries.push_back({kept.offset, 0, kept.planned - slice.first_block, 0, kept.kept_bits});
  }
}

// The same block once more, for the functions that correct samples of it.
void Exposer::add_correction(const TableSlice& slice, std::size_t planned,
                             std::vector<BlockEntry>& entries) const {
  const auto found = std::ranges::lower_bound(slice.corrected, planned);
  if (found == slice.corrected.end() || *found != planned) return;
  BlockEntry entry = entries.back();
  entry.kept_bits = 0;
  entry.table_row = slice.last_row - slice.first_row;
  for (auto before = slice.corrected.begin(); before != found; ++before) {
    entry.table_row += plan_.blocks[*before].row_count();
  }
  entry.part_row =
      slice.last_block - slice.first_block + static_cast<std::size_t>(found - slice.corrected.begin());
  entries.push_back(entry);
}

// Σ_k v_k w_k of every pixel of the bands, slice by slice, chunk by chunk. Kept sums stand between the blocks around
// them: each pixel's are added in time order.
void Exposer::sum_up(std::span<const ExposedBand> bands, const RenderControl& control) {
  auto fetched = fetched_.begin();
  std::size_t next_kept = 0;
  bool is_first = true;
  for (const TableSlice& slice : kernel_.slices) {
    const DeviceMemory::Scope slice_scope(memory_);
    const SliceTables tables = kernel_.tables(slice);
    for (std::size_t blocks = read_blocks(slice.first_block, slice.last_block); blocks > 0;) {
      throw_if_cancelled(control);
      const DeviceMemory::Scope chunk_scope(memory_);
      BlockFeed::Chunk fresh;
      if (fetched == fetched_.end()) {
        fresh = next_chunk();
        memory_.count(fresh.host_bytes);
      }
      const BlockFeed::Chunk& chunk = fetched == fetched_.end() ? fresh : *fetched++;
      memory_.count(device_.feed.bytes());
      std::vector<BlockEntry> entries;
      for (BlockEntry entry : chunk.entries) {
        const std::size_t planned = slice.first_block + entry.part_row;
        add_kept(slice, planned, next_kept, entries);
        if (!kept_.kept_bits.empty()) entry.kept_bits = kept_.kept_bits[planned];
        entries.push_back(entry);
        add_correction(slice, planned, entries);
      }
      launch(chunk.payload, entries, tables, bands, control, std::exchange(is_first, false));
      blocks -= chunk.entries.size();
      read_ += chunk.entries.size();
      if (control.progress) control.progress(read_, to_read_);
    }
    std::vector<BlockEntry> entries;
    add_kept(slice, slice.last_block - 1, next_kept, entries);
    if (!entries.empty()) launch(kept_.sums, entries, tables, bands, control, std::exchange(is_first, false));
  }
}

void Exposer::launch(const cl::Buffer& payload, std::span<const BlockEntry> entries,
                     const SliceTables& tables, std::span<const ExposedBand> bands,
                     const RenderControl& control, bool is_first) {
  const std::uint64_t max_samples = max_samples_a_launch(device_.info, work_.shape);
  for (const std::span<const BlockEntry> part : launches_of(entries, max_samples)) {
    const cl::Buffer entries_of_part = memory_.upload(part);
    for (const ExposedBand& exposed : bands) {
      throw_if_cancelled(control);
      const ExposeLaunch launched{exposed.band.sum_tiles, static_cast<cl_uint>(part.size()),
                                  static_cast<cl_uint>(plan_.function_count()), is_first ? 1u : 0u};
      take_back_signals();  // what was launched before may have been compiled at that moment
      const cl::Event event = kernel_.launch(payload, entries_of_part, tables, exposed, launched);
      event.wait();
      take_back_signals();
      const std::optional<double> took_ms = milliseconds(event);
      statistics_.expose_ms += took_ms.value_or(0.0);
      statistics_.is_timed &= took_ms.has_value();
      ++statistics_.launches;
    }
    is_first = false;
  }
}

BlockFeed::Chunk Exposer::next_chunk() {
  const auto start = std::chrono::steady_clock::now();
  BlockFeed::Chunk chunk = device_.feed.next();
  statistics_.read_ms +=
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  statistics_.blocks += chunk.entries.size();
  statistics_.payload_bytes += chunk.payload_bytes;
  if (device_.last_block_first) std::ranges::reverse(chunk.entries);
  return chunk;
}

}  // namespace nutik
