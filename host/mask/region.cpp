#include "mask/region.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "system/interruption.hpp"

namespace nutik {
namespace {

// A region of the pixels whose centres `holds` holds.
template <typename Holds>
Region of_centres(std::uint32_t width, std::uint32_t height, Holds holds) {
  Region region = Region::none(width, height);
  std::size_t pixel = 0;
  for (std::uint32_t y = 0; y < height; ++y) {
    check_interruption();
    for (std::uint32_t x = 0; x < width; ++x, ++pixel) region.inside[pixel] = holds(x + 0.5, y + 0.5) ? 1 : 0;
  }
  return region;
}

// The part of `region` that hangs together with `start`; its pixels are cleared from `rest`.
std::vector<std::size_t> take_part(Region& rest, std::size_t start) {
  std::vector<std::size_t> part{start};
  rest.inside[start] = 0;
  for (std::size_t next = 0; next < part.size(); ++next) {
    if (next % 4096 == 0) check_interruption();
    const std::size_t x = part[next] % rest.width, y = part[next] / rest.width;
    for (std::size_t v = y == 0 ? 0 : y - 1; v <= std::min<std::size_t>(y + 1, rest.height - 1); ++v) {
      for (std::size_t u = x == 0 ? 0 : x - 1; u <= std::min<std::size_t>(x + 1, rest.width - 1); ++u) {
        const std::size_t neighbour = v * rest.width + u;
        if (rest.inside[neighbour] == 0) continue;
        rest.inside[neighbour] = 0;
        part.push_back(neighbour);
      }
    }
  }
  return part;
}

}  // namespace

std::uint64_t Region::pixel_count() const {
  return static_cast<std::uint64_t>(std::count(inside.begin(), inside.end(), std::uint8_t{1}));
}

Region rectangle(std::uint32_t width, std::uint32_t height, Point corner, double shape_width,
                 double shape_height) {
  return of_centres(width, height, [&](double x, double y) {
    return x >= corner.x && x < corner.x + shape_width && y >= corner.y && y < corner.y + shape_height;
  });
}

Region ellipse(std::uint32_t width, std::uint32_t height, Point centre, double radius_x, double radius_y) {
  return of_centres(width, height, [&](double x, double y) {
    return std::hypot((x - centre.x) / radius_x, (y - centre.y) / radius_y) <= 1.0;
  });
}

Region polygon(std::uint32_t width, std::uint32_t height, std::span<const Point> corners) {
  if (corners.size() < 3) throw std::logic_error("a polygon needs three corners");
  Region region = Region::none(width, height);
  std::vector<double> crossings;
  for (std::uint32_t row = 0; row < height; ++row) {
    const double y = row + 0.5;
    crossings.clear();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Point a = corners[i], b = corners[(i + 1) % corners.size()];
      // Half open, so that a corner on the line counts once.
      if ((a.y <= y) == (b.y <= y)) continue;
      crossings.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      // Pixels whose centre x + 1/2 lies in [crossing, next crossing).
      const auto column = [&](double x) { return std::clamp(std::ceil(x - 0.5), 0.0, double(width)); };
      const auto first = static_cast<std::size_t>(column(crossings[i]));
      const auto last = static_cast<std::size_t>(column(crossings[i + 1]));
      const auto start = region.inside.begin() + static_cast<std::ptrdiff_t>(std::size_t{row} * width);
      std::fill(start + static_cast<std::ptrdiff_t>(first), start + static_cast<std::ptrdiff_t>(last),
                std::uint8_t{1});
    }
  }
  return region;
}

Region inverted(const Region& region) {
  Region result = region;
  for (std::uint8_t& inside : result.inside) inside ^= 1;
  return result;
}

Region intersection(const Region& a, const Region& b) {
  Region result = a;
  for (std::size_t pixel = 0; pixel < result.inside.size(); ++pixel) result.inside[pixel] &= b.inside[pixel];
  return result;
}

std::vector<std::vector<std::size_t>> parts_of(const Region& region, std::size_t min_pixels) {
  Region rest = region;
  std::vector<std::vector<std::size_t>> parts;
  for (std::size_t pixel = 0; pixel < rest.inside.size(); ++pixel) {
    if (rest.inside[pixel] == 0) continue;
    std::vector<std::size_t> part = take_part(rest, pixel);
    if (part.size() >= min_pixels) parts.push_back(std::move(part));
  }
  std::ranges::stable_sort(parts, std::greater(), &std::vector<std::size_t>::size);
  return parts;
}

Region largest_part(const Region& region) {
  Region result = Region::none(region.width, region.height);
  const auto parts = parts_of(region, 1);
  if (parts.empty()) return result;
  for (const std::size_t pixel : parts.front()) result.inside[pixel] = 1;
  return result;
}

Region with_holes_filled(const Region& region) {
  Region result = region;
  const std::size_t last_column = region.width - 1, last_row = std::size_t{region.width} * (region.height - 1);
  for (const auto& part : parts_of(inverted(region), 1)) {
    const auto is_at_border = [&](std::size_t pixel) {
      const std::size_t column = pixel % region.width;
      return column == 0 || column == last_column || pixel < region.width || pixel >= last_row;
    };
    if (std::ranges::any_of(part, is_at_border)) continue;
    for (const std::size_t pixel : part) result.inside[pixel] = 1;
  }
  return result;
}

void paint(Mask& mask, const Region& region, std::uint8_t tag) {
  for (std::size_t pixel = 0; pixel < mask.tags.size(); ++pixel) {
    if (region.inside[pixel] != 0) mask.tags[pixel] = tag;
  }
}

void paint_grid(Mask& mask, const Region& region, std::uint32_t columns, std::uint32_t rows,
                std::uint8_t first_tag) {
  if (columns == 0 || rows == 0 || first_tag + std::uint64_t{columns} * rows > kMaskValues) {
    throw std::logic_error("paint_grid: no cell, or a tag above 255");
  }
  // The cell that holds the centre of pixel k of `pixels`: floor((k + ½) · cells / pixels).
  const auto cell = [](std::uint64_t k, std::uint64_t cells, std::uint64_t pixels) {
    return (2 * k + 1) * cells / (2 * pixels);
  };
  std::size_t pixel = 0;
  for (std::uint32_t y = 0; y < mask.height; ++y) {
    const std::uint64_t first_of_row = first_tag + cell(y, rows, mask.height) * columns;
    for (std::uint32_t x = 0; x < mask.width; ++x, ++pixel) {
      if (region.inside[pixel] == 0) continue;
      mask.tags[pixel] = static_cast<std::uint8_t>(first_of_row + cell(x, columns, mask.width));
    }
  }
}

}  // namespace nutik
