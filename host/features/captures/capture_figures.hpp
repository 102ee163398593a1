// What a capture comes to, told from its directory without its samples.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "capture/error.hpp"
#include "imev/tile.hpp"
#include "tik/reader.hpp"

namespace nutik {

struct CaptureFigures {
  std::array<std::uint64_t, 4> tiles{};  // by TileKind
  // At most, where sides are no multiples of kTileSide: what fills edge tiles was once counted, too.
  std::uint64_t record_count = 0;
  bool is_record_count_exact = true;
  std::uint64_t payload_bytes = 0;  // unpacked
  std::uint64_t raw_bytes = 0;      // all samples, as they were before they were encoded
  std::vector<InputError> damage;   // blocks whose tiles are not counted

  [[nodiscard]] std::uint64_t tile_count() const;
};

[[nodiscard]] CaptureFigures figures_of(tik::Reader& reader);

}  // namespace nutik
