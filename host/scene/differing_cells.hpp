// Where samples differ from the plate, in cells of several pixels, so that large pictures take no longer.
#pragma once

#include <cstdint>
#include <vector>

#include "capture/picture.hpp"
#include "mask/region.hpp"
#include "scene/looks.hpp"

namespace nutik {

// Cells that differ from the plate, in half of their pixels or more, and those of them that are no shadow; and by how
// much all do, in shares of white.
struct DifferingCells {
  Region region, solid;
  std::vector<float> contrast;
};

// Follows one look after another: places are looked at again only if something changed there since the look before.
class Difference {
 public:
  // A pixel differs where a channel does by more than `by_codes`.
  Difference(const CaptureFormat& capture, const Picture& plate, std::uint32_t by_codes);

  // The side of a cell, in pixels.
  [[nodiscard]] static std::uint32_t side(const Shape& shape);

  const DifferingCells& at(const Look& look);

 private:
  template <typename Code>
  void update(const Look& look);
  template <typename Code>
  void update_tile(std::uint32_t tile, const Code* codes);
  void mark_cells(std::uint32_t tile, std::uint64_t look);
  // What its cells show, each by its first pixel.
  template <typename Code>
  void show_tile(std::uint32_t tile, const Code* codes, Picture& small) const;
  template <typename Code>
  void update_cell(std::uint32_t row, std::uint32_t column);

  Shape shape_;
  TileGrid grid_;
  std::uint32_t white_code_, by_codes_;
  std::uint32_t side_, columns_, rows_;
  std::vector<std::byte> plate_;       // [tile][channel][lane]
  std::vector<std::byte> difference_;  // of each pixel's channel that differs most, row by row
  Picture seen_, seen_plate_;          // a pixel a cell
  DifferingCells cells_;
  std::vector<std::uint64_t> looked_at_;  // the last look at each cell
};

}  // namespace nutik
