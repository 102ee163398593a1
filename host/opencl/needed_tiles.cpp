#include "opencl/needed_tiles.hpp"

#include <algorithm>

#include "opencl/kernel_layout.hpp"

namespace nutik {
namespace {

bool is_read(std::uint32_t function, const std::vector<bool>& live) {
  return function == kMixedFunctions || (function < live.size() && live[function]);
}

}  // namespace

const std::vector<std::uint32_t>& NeededTiles::functions() const {
  if (functions_.empty()) {
    functions_.assign(TileGrid(plan_.capture.shape).tile_count(), kUnread);
    for (const ExposedBand& exposed : bands_) {
      const FunctionMap& map = *exposed.map.host;
      for (std::uint64_t tile = 0; tile < map.tiles.size(); ++tile) {
        std::uint32_t& function = functions_[map.tiles[tile]];
        function = function == kUnread ? map.of_tile[tile] : kMixedFunctions;
      }
    }
  }
  return functions_;
}

bool NeededTiles::is_exposed(std::uint64_t tile, const SampleRange& samples) const {
  if (needs_.empty()) {
    const TileGrid grid(plan_.capture.shape);
    needs_.resize(grid.tile_count());
    for (std::uint64_t each = 0; each < needs_.size(); ++each) {
      SampleRange& needed = needs_[each];
      const auto add = [&](std::uint16_t function) { needed.cover(plan_.functions[function].live); };
      grid.for_each_lane(each, [&](std::uint32_t, std::uint64_t pixel) {
        const std::span<const Share> shares = plan_.shares_of(pixel);
        if (shares.empty()) add(plan_.function_of(pixel));
        for (const Share& share : shares) add(share.of);
      });
    }
  }
  const SampleRange& needed = needs_[tile];
  return functions()[tile] != kUnread && needed.first < samples.last && samples.first < needed.last;
}

std::vector<bool> NeededTiles::live_in(const PlannedBlock& planned) const {
  std::vector<bool> live;
  for (const PlannedFunction& function : plan_.functions) {
    live.push_back(!function.table->span_in(planned.extent).empty());
  }
  return live;
}

WantsTiles NeededTiles::of(const PlannedBlock& planned) const {
  if (plan_.map->has_delays()) {
    return [this, samples = planned.extent.range()](std::uint64_t first, std::uint64_t last) {
      while (first < last && !is_exposed(first, samples)) ++first;
      return first < last;
    };
  }
  return [this, live = live_in(planned)](std::uint64_t first, std::uint64_t last) {
    const auto tiles = std::span(functions()).subspan(first, last - first);
    return std::ranges::any_of(tiles, [&](std::uint32_t function) { return is_read(function, live); });
  };
}

bool NeededTiles::are_among(const std::vector<bool>& there, const PlannedBlock& planned) const {
  const bool has_delays = plan_.map->has_delays();
  const std::vector<bool> live = has_delays ? std::vector<bool>() : live_in(planned);
  for (std::uint64_t tile = 0; tile < there.size(); ++tile) {
    if (there[tile]) continue;
    if (has_delays ? is_exposed(tile, planned.extent.range()) : is_read(functions()[tile], live)) return false;
  }
  return true;
}

}  // namespace nutik
