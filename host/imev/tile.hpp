// How a picture is cut into tiles of 8 × 8 pixels, the unit in which an IMEV is stored and read.
//
//        x 0 … 7   8 … 15         A tile's pixels are its 64 lanes, row by row:
//   y 0 ┌────────┬────────┬─          lane 0  1  2  3  4  5  6  7
//     … │ tile 0 │ tile 1 │ …              8  9 …
//     7 ├────────┼────────┼─
//     8 │ tile n │        │          Tiles at the right and bottom edge are padded: lanes outside
//                                    the picture repeat the nearest pixel inside.
#pragma once

#include <cstdint>

#include "capture/picture.hpp"

namespace nutik {

inline constexpr std::uint32_t kTileSide = 8;
inline constexpr std::uint32_t kTilePixels = kTileSide * kTileSide;

class TileGrid {
 public:
  explicit TileGrid(const Shape& shape)
      : width_(shape.width),
        height_(shape.height),
        columns_((shape.width + kTileSide - 1) / kTileSide),
        rows_((shape.height + kTileSide - 1) / kTileSide) {}

  [[nodiscard]] std::uint32_t columns() const { return columns_; }
  [[nodiscard]] std::uint32_t rows() const { return rows_; }
  [[nodiscard]] std::uint64_t tile_count() const { return std::uint64_t{columns_} * rows_; }

  [[nodiscard]] std::uint64_t tile_of(std::uint32_t x, std::uint32_t y) const {
    return std::uint64_t{y / kTileSide} * columns_ + x / kTileSide;
  }
  [[nodiscard]] static std::uint32_t lane_of(std::uint32_t x, std::uint32_t y) {
    return y % kTileSide * kTileSide + x % kTileSide;
  }

  // Calls visit(lane, pixel) for each lane of a tile; a padded lane gets the nearest pixel inside, so
  // that its pixel index (row-major) is always valid.
  template <typename Visit>
  void for_each_lane(std::uint64_t tile, Visit visit) const {
    const auto left = static_cast<std::uint32_t>(tile % columns_) * kTileSide;
    const auto top = static_cast<std::uint32_t>(tile / columns_) * kTileSide;
    for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
      const std::uint32_t x = left + lane % kTileSide;
      const std::uint32_t y = top + lane / kTileSide;
      const std::uint32_t inside_x = x < width_ ? x : width_ - 1;
      const std::uint32_t inside_y = y < height_ ? y : height_ - 1;
      visit(lane, std::uint64_t{inside_y} * width_ + inside_x);
    }
  }

 private:
  std::uint32_t width_;
  std::uint32_t height_;
  std::uint32_t columns_;
  std::uint32_t rows_;
};

}  // namespace nutik
