#include "align/seen_area.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace nutik {
namespace {

constexpr double kRounding = 1e-6;

}  // namespace

PixelSpan seen_span(const Warp& warp, const Shape& shape, std::uint32_t row) {
  const auto& m = warp.m;
  const double y = row;
  double low = 0, high = shape.width - 1;
  // a x + b >= 0 for the four borders and for what lies before the camera.
  const auto cut = [&](double a, double b) {
    if (a > 0) {
      low = std::max(low, -b / a);
    } else if (a < 0) {
      high = std::min(high, -b / a);
    } else if (b < 0) {
      high = -1;
    }
  };
  const double x_rest = m[1] * y + m[2], y_rest = m[4] * y + m[5], z_rest = m[7] * y + m[8];
  const double right = shape.width - 1 + kSeenBeyond, bottom = shape.height - 1 + kSeenBeyond;
  cut(m[6], z_rest - kRounding);
  cut(m[0] + kSeenBeyond * m[6], x_rest + kSeenBeyond * z_rest);
  cut(m[3] + kSeenBeyond * m[6], y_rest + kSeenBeyond * z_rest);
  cut(right * m[6] - m[0], right * z_rest - x_rest);
  cut(bottom * m[6] - m[3], bottom * z_rest - y_rest);
  const double first = std::ceil(low - kRounding), last = std::floor(high + kRounding);
  if (!(first <= last)) return {};
  return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last) + 1};
}

std::optional<Rectangle> seen_by_all(const CameraPath& path) {
  const Shape& shape = path.shape;
  std::vector<PixelSpan> rows(shape.height, PixelSpan{0, shape.width});
  for (const Registered& picture : path.pictures) {
    for (std::uint32_t y = 0; y < shape.height; ++y) {
      const PixelSpan span = seen_span(picture.warp, shape, y);
      rows[y].first = std::max(rows[y].first, span.first);
      rows[y].end = std::min(rows[y].end, span.end);
    }
  }
  // What all saw is convex, so that a rectangle lies in it if its first and its last row do.
  std::optional<Rectangle> best;
  std::uint64_t most = 0;
  for (std::uint32_t top = 0; top < shape.height; ++top) {
    for (std::uint32_t bottom = top; bottom < shape.height; ++bottom) {
      const std::uint32_t first = std::max(rows[top].first, rows[bottom].first);
      const std::uint32_t end = std::min(rows[top].end, rows[bottom].end);
      if (first >= end) continue;
      const std::uint64_t pixels = std::uint64_t{end - first} * (bottom - top + 1);
      if (pixels <= most) continue;
      most = pixels;
      best = Rectangle{first, top, end - first, bottom - top + 1};
    }
  }
  return best;
}

Picture coverage_of(const CameraPath& path) {
  const Shape& shape = path.shape;
  Picture coverage({shape.width, shape.height, 1}, ValueType::code8, 255);
  auto* code = coverage.values<std::uint8_t>().data();
  const std::uint64_t all = std::max<std::uint64_t>(path.pictures.size(), 1);
  std::vector<std::uint64_t> seen(shape.width);  // of a row
  for (std::uint32_t y = 0; y < shape.height; ++y) {
    std::ranges::fill(seen, 0);
    for (const Registered& picture : path.pictures) {
      const PixelSpan span = seen_span(picture.warp, shape, y);
      for (std::uint32_t x = span.first; x < span.end; ++x) ++seen[x];
    }
    // Rounded down: 255 is kept for what all saw.
    for (const std::uint64_t count : seen) *code++ = static_cast<std::uint8_t>(255 * count / all);
  }
  return coverage;
}

}  // namespace nutik
