#include "opencl/exposer.hpp"

#include <algorithm>
#include <chrono>

#include "opencl/launch.hpp"
#include "opencl/needed_tiles.hpp"

namespace nutik {
namespace {

using ExposeKernel =
    cl::KernelFunctor<cl::Buffer, cl::Buffer, cl_uint, cl::Buffer, cl::Buffer, cl::Buffer, cl_uint,
                      cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer, cl_ulong, cl_uint>;

// Nothing is read from a capture any more when its exposure ends, however it does.
class StoppedAtEnd {
 public:
  explicit StoppedAtEnd(BlockFeed& feed) : feed_(feed) {}
  ~StoppedAtEnd() { feed_.stop(); }
  StoppedAtEnd(const StoppedAtEnd&) = delete;
  StoppedAtEnd& operator=(const StoppedAtEnd&) = delete;

 private:
  BlockFeed& feed_;
};

// A chunk's blocks, cut so that no launch reads more samples, but one block at least.
std::vector<std::span<const BlockEntry>> launches_of(std::span<const BlockEntry> entries,
                                                     std::uint64_t most_samples) {
  std::vector<std::span<const BlockEntry>> launches;
  std::size_t first = 0;
  std::uint64_t samples = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (i > first && samples + entries[i].sample_count > most_samples) {
      launches.push_back(entries.subspan(first, i - first));
      first = i;
      samples = 0;
    }
    samples += entries[i].sample_count;
  }
  launches.push_back(entries.subspan(first));
  return launches;
}

}  // namespace

void Exposer::expose(std::span<ExposedBand> bands, const RenderControl& control, const Develop& develop) {
  const std::vector<TableSlice> slices =
      cut_tables(plan_, work_.precision, device_.info, shares_.slice_bytes);
  const NeededTiles tiles(plan_, bands);
  device_.feed.start(plan_, slices, source_, tiles, shares_.feed);
  const StoppedAtEnd stopped(device_.feed);
  const DeviceMemory::Scope scope(memory_);
  // Tables of several slices would have to be written anew for each band.
  const bool are_all_there = bands.size() > 1 && slices.size() == 1 && fetch_all();
  const std::size_t bands_at_once = are_all_there ? 1 : bands.size();
  for (std::size_t first = 0; first < bands.size(); first += bands_at_once) {
    const std::span<ExposedBand> exposed = bands.subspan(first, bands_at_once);
    const DeviceMemory::Scope sums_scope(memory_);
    for (ExposedBand& each : exposed) {
      each.sums = memory_.allocate(
          sums_bytes(each.band.sum_tiles, plan_.capture.shape.channels, work_.precision), CL_MEM_READ_WRITE);
    }
    sum_up(exposed, slices, control);
    throw_if_cancelled(control);
    memory_.count(device_.feed.bytes());
    for (ExposedBand& each : exposed) {
      develop(each);
      each.sums = {};
    }
  }
}

bool Exposer::fetch_all() {
  std::uint64_t bytes = 0;
  for (std::size_t blocks = 0; blocks < plan_.blocks.size();) {
    const BlockFeed::Chunk& chunk = fetched_.emplace_back(next_chunk());
    blocks += chunk.entries.size();
    memory_.count(chunk.host_bytes);
    bytes += chunk.payload_bytes;
    // More than may stay is more than the system may hold of a file: each band would read it again.
    if (!chunk.stays || bytes > shares_.feed.resident_bytes)
      return blocks == plan_.blocks.size() && chunk.stays;
  }
  return true;
}

// Σ_k v_k w_k of every pixel of the bands, slice by slice, chunk by chunk.
void Exposer::sum_up(std::span<const ExposedBand> bands, std::span<const TableSlice> slices,
                     const RenderControl& control) {
  auto fetched = fetched_.begin();
  std::size_t block = 0;
  for (const TableSlice& slice : slices) {
    const DeviceMemory::Scope slice_scope(memory_);
    const SliceTables tables =
        device_.tables.slice(plan_, slice, work_.precision, memory_, statistics_.table_bytes_written);
    while (block < slice.last_block) {
      throw_if_cancelled(control);
      const DeviceMemory::Scope chunk_scope(memory_);
      BlockFeed::Chunk fresh;
      if (fetched == fetched_.end()) {
        fresh = next_chunk();
        memory_.count(fresh.host_bytes);
      }
      const BlockFeed::Chunk& chunk = fetched == fetched_.end() ? fresh : *fetched++;
      memory_.count(device_.feed.bytes());
      launch(chunk, tables, bands, block == 0);
      block += chunk.entries.size();
    }
  }
}

void Exposer::launch(const BlockFeed::Chunk& chunk, const SliceTables& tables,
                     std::span<const ExposedBand> bands, bool is_first) {
  ExposeKernel kernel(kernel_);
  const std::uint64_t most_samples = most_samples_a_launch(device_.info, work_.shape);
  for (const std::span<const BlockEntry> part : launches_of(chunk.entries, most_samples)) {
    const cl::Buffer entries = memory_.upload(part);
    for (const ExposedBand& exposed : bands) {
      const Band& band = exposed.band;
      const cl::Event event =
          kernel(items(device_.queue, work_.shape, band.sum_tiles), chunk.payload, entries,
                 static_cast<cl_uint>(part.size()), tables.spans, tables.weights, tables.boundaries,
                 static_cast<cl_uint>(plan_.function_count()), exposed.map.tiles, exposed.map.of_tile,
                 exposed.map.of_lane, light_, exposed.sums, band.sum_tiles, is_first ? 1u : 0u);
      event.wait();
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
