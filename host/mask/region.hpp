// A region of a picture: which of its pixels belong to it.
//
//   in:      shapes with the size of the picture; another region
//   out:     a region of the same size, or a mask on which it has a tag
//   units:   pixels from the top left corner. Coordinates are real numbers; pixel (x, y) covers
//            [x, x + 1] × [y, y + 1] and belongs to a shape that holds its centre
//   always:  inside.size() = width · height, row by row, each 0 or 1
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "exposure/mask.hpp"

namespace nutik {

struct Region {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> inside;

  // One that holds no pixel, or every one.
  static Region none(std::uint32_t width, std::uint32_t height) {
    return {width, height, std::vector<std::uint8_t>(std::size_t{width} * height, 0)};
  }
  static Region all(std::uint32_t width, std::uint32_t height) {
    return {width, height, std::vector<std::uint8_t>(std::size_t{width} * height, 1)};
  }

  [[nodiscard]] std::uint64_t pixel_count() const;

  friend bool operator==(const Region&, const Region&) = default;
};

struct Point {
  double x = 0.0;
  double y = 0.0;
  friend bool operator==(const Point&, const Point&) = default;
};

// Shapes; what of them lies outside the picture is cut off. A rectangle from its top left corner; an ellipse
// round its centre, with half its width and height; a polygon of three corners or more, closed from the
// last to the first, even-odd where it crosses itself. Throws std::logic_error for fewer corners.
[[nodiscard]] Region rectangle(std::uint32_t width, std::uint32_t height, Point corner, double shape_width,
                               double shape_height);
[[nodiscard]] Region ellipse(std::uint32_t width, std::uint32_t height, Point centre, double radius_x,
                             double radius_y);
[[nodiscard]] Region polygon(std::uint32_t width, std::uint32_t height, std::span<const Point> corners);

// Every pixel that is not inside, or is inside both. The regions have one size.
[[nodiscard]] Region inverted(const Region& region);
[[nodiscard]] Region intersection(const Region& a, const Region& b);

// The largest part that hangs together, also over corners; of several as large the one that comes first row
// by row.
[[nodiscard]] Region largest_part(const Region& region);

// With what it encloses: from where no way leads to the picture's border, not even over corners.
[[nodiscard]] Region with_holes_filled(const Region& region);

// The parts that hang together, also over corners, of so many pixels or more, as pixels counted row by row: the largest
// first.
[[nodiscard]] std::vector<std::vector<std::size_t>> parts_of(const Region& region, std::size_t min_pixels);

// Gives the region's pixels a tag; the others keep theirs. Mask and region have one size.
void paint(Mask& mask, const Region& region, std::uint8_t tag);

// The same with a tag for each cell of a grid over the whole picture: `first_tag` at the top left, one more from cell
// to cell along each row. Cells are as equal as whole pixels allow; a pixel belongs to the cell that holds its
// centre. Throws std::logic_error for a grid of no cell or of tags above 255.
void paint_grid(Mask& mask, const Region& region, std::uint32_t columns, std::uint32_t rows,
                std::uint8_t first_tag);

}  // namespace nutik
