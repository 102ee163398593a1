// Places of a picture that can be recognized in another.
#pragma once

#include <cmath>
#include <cstddef>
#include <opencv2/core.hpp>
#include <vector>

namespace nutik::motion {

struct Point {
  float x, y;  // of the level
  float grey;
  float gradient_x, gradient_y;
};

[[nodiscard]] inline double gradient_of(const Point& point) {
  return std::hypot(point.gradient_x, point.gradient_y);
}

// The strongest edges of each part of a picture in grey (grey_pyramid.hpp), some `count` from all over it.
[[nodiscard]] std::vector<Point> textured_points(const cv::Mat& grey, std::size_t count);

}  // namespace nutik::motion
