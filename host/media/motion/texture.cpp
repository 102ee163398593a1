#include "media/motion/registration.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace nutik::motion {
namespace {

constexpr std::uint32_t kCells = 32;  // along the longer side: the texture is taken from all over the picture
constexpr double kMinGradient = kGreyWhite / 256;  // a pixel
constexpr double kWeakGradient = 0.05;             // of the strongest: mostly noise
constexpr float kMargin = 4;

}  // namespace

std::vector<Point> textured_points(const cv::Mat& grey, std::size_t count) {
  const int side = std::max(8, std::max(grey.cols, grey.rows) / static_cast<int>(kCells));
  const int columns = (grey.cols - 1) / side + 1, rows = (grey.rows - 1) / side + 1;
  std::vector<std::vector<Point>> cells(static_cast<std::size_t>(columns * rows));
  const std::size_t most = std::max<std::size_t>(1, count / cells.size());
  const auto keep_strongest = [most](std::vector<Point>& cell) {
    if (cell.size() <= most) return;
    std::ranges::nth_element(cell, cell.begin() + static_cast<std::ptrdiff_t>(most), std::greater(),
                             gradient_of);
    cell.resize(most);
  };
  for (int y = static_cast<int>(kMargin); y < grey.rows - static_cast<int>(kMargin); ++y) {
    const auto *above = grey.ptr<float>(y - 1), *row = grey.ptr<float>(y), *below = grey.ptr<float>(y + 1);
    for (int x = static_cast<int>(kMargin); x < grey.cols - static_cast<int>(kMargin); ++x) {
      const Point point{static_cast<float>(x), static_cast<float>(y), row[x], (row[x + 1] - row[x - 1]) / 2,
                        (below[x] - above[x]) / 2};
      if (gradient_of(point) < kMinGradient) continue;
      std::vector<Point>& cell = cells[static_cast<std::size_t>(y / side * columns + x / side)];
      cell.push_back(point);
      if (cell.size() >= 4 * most) keep_strongest(cell);
    }
  }
  std::vector<Point> points;
  for (std::vector<Point>& cell : cells) {
    keep_strongest(cell);
    points.insert(points.end(), cell.begin(), cell.end());
  }
  if (points.empty()) return points;
  const double weak = kWeakGradient * gradient_of(*std::ranges::max_element(points, {}, gradient_of));
  std::erase_if(points, [&](const Point& point) { return gradient_of(point) < weak; });
  return points;
}

}  // namespace nutik::motion
