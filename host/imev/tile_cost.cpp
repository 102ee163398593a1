#include "imev/tile_cost.hpp"

namespace nutik {

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
