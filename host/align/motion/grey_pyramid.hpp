// A picture as a registrar looks at it: grey, a little blurred, smaller and smaller; and its places that can be
// recognized in another.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "capture/picture.hpp"

namespace nutik::motion {

inline constexpr double kGreyWhite = 255;

struct GreyPyramid {
  // In the memory of the picture before: pages that are new to a process cost as much as what is done with them.
  void take(const CaptureFormat& format, std::span<const std::byte> raster);

  // An 8-bit picture for features, and its pixels' size in those of the original.
  [[nodiscard]] cv::Mat of_features() const;
  [[nodiscard]] double feature_scale() const;

  int finest = 0;  // the pixels of levels[0] are squares of 2^finest of the picture's, of levels[1] twice as many
  std::vector<cv::Mat> levels;  // of floats; pixel (x, y) of each lies at a pixel of the one before

 private:
  std::array<cv::Mat, 16> greys_;  // before they are blurred; no picture has more levels
};

struct Point {
  float x, y;  // of the level
  float grey;
  float gradient_x, gradient_y;
};

[[nodiscard]] inline double gradient_of(const Point& point) {
  return std::hypot(point.gradient_x, point.gradient_y);
}

// The strongest edges of each part of a picture in grey, some `count` from all over it.
[[nodiscard]] std::vector<Point> textured_points(const cv::Mat& grey, std::size_t count);

}  // namespace nutik::motion
