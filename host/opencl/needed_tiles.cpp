#include "opencl/needed_tiles.hpp"

#include <algorithm>

#include "opencl/kernel_layout.hpp"

namespace nutik {
namespace {

bool is_read(std::uint16_t function, const std::vector<bool>& live) {
  return function == kMixedFunctions || (function < live.size() && live[function]);
}

}  // namespace

const std::vector<std::uint16_t>& NeededTiles::functions() const {
  if (functions_.empty()) {
    functions_.assign(TileGrid(plan_.capture.shape).tile_count(), kUnread);
    for (const ExposedBand& exposed : bands_) {
      const FunctionMap& map = *exposed.map.host;
      for (std::uint64_t tile = 0; tile < map.tiles.size(); ++tile) {
        std::uint16_t& function = functions_[map.tiles[tile]];
        function = function == kUnread ? map.of_tile[tile] : kMixedFunctions;
      }
    }
  }
  return functions_;
}

std::vector<bool> NeededTiles::live_in(const PlannedBlock& planned) const {
  std::vector<bool> live;
  for (const PlannedFunction& function : plan_.functions) {
    live.push_back(!function.table->span_in(planned.extent).empty());
  }
  return live;
}

WantsTiles NeededTiles::of(const PlannedBlock& planned) const {
  return [this, live = live_in(planned)](std::uint64_t first, std::uint64_t last) {
    const auto tiles = std::span(functions()).subspan(first, last - first);
    return std::ranges::any_of(tiles, [&](std::uint16_t function) { return is_read(function, live); });
  };
}

bool NeededTiles::are_among(const std::vector<bool>& there, const PlannedBlock& planned) const {
  const std::vector<bool> live = live_in(planned);
  for (std::uint64_t tile = 0; tile < there.size(); ++tile) {
    if (!there[tile] && is_read(functions()[tile], live)) return false;
  }
  return true;
}

}  // namespace nutik
