#include "imev/tile_cost.hpp"

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {

TilePolicy parse_tile_policy(std::string_view text) {
  if (text == "auto") return TilePolicy::automatic;
  if (text == "dense") return TilePolicy::dense;
  if (text == "rows") return TilePolicy::rows;
  if (text == "records") return TilePolicy::records;
  throw UsageError(format("tile kind '{}' is not known; choose auto, dense, rows or records", text));
}

std::string to_text(TilePolicy policy) {
  switch (policy) {
    case TilePolicy::automatic: return "auto";
    case TilePolicy::dense: return "dense";
    case TilePolicy::rows: return "rows";
    case TilePolicy::records: return "records";
  }
  return {};
}

}  // namespace nutik
