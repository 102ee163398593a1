// What a registrar is made of (registrar.cpp).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <optional>
#include <span>
#include <vector>

#include "align/warp.hpp"
#include "capture/picture.hpp"

namespace nutik::motion {

// A picture as a registrar looks at it: grey, a little blurred, and smaller and smaller.

inline constexpr double kGreyWhite = 255;

struct GreyPyramid {
  // In the memory of the picture before: pages that are new to a process cost as much as what is done with them.
  void take(const CaptureFormat& format, std::span<const std::byte> raster);

  // Of 8 bits, for features, and how many of the picture's pixels are one of its.
  [[nodiscard]] cv::Mat of_features() const;
  [[nodiscard]] double feature_scale() const;

  int finest = 0;  // the pixels of levels[0] are 2^finest of the picture's, of levels[1] twice as many
  std::vector<cv::Mat> levels;  // of floats; pixel (x, y) of each lies at a pixel of the one before

 private:
  std::vector<cv::Mat> greys_;  // before they are blurred, the picture itself first
};

// Places of a picture that can be recognized in another.

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

// About where a picture lies, by matched features: from any distance, to a pixel or so.

class FeatureStart {
 public:
  // `scale` of the picture's own pixels are one of these.
  FeatureStart(const cv::Mat& reference, double scale);

  // Of a picture of the same size: moved and turned, not scaled. Nothing where too few features agree.
  [[nodiscard]] std::optional<Warp> find(const cv::Mat& picture);

 private:
  cv::Ptr<cv::SIFT> detector_;
  std::vector<cv::KeyPoint> points_;
  cv::Mat descriptors_;
  double scale_;
};

// Weighted least squares of a few numbers: what is added up for them, and their solution.

class NormalEquations {
 public:
  static constexpr std::size_t kMaxNumbers = 10;
  // As many as fill vectors: those beyond the numbers are zero.
  using Row = std::array<double, 12>;

  explicit NormalEquations(std::size_t numbers) : numbers_(numbers) {}

  // That the numbers, each times the slope of the same place, add up to `value`.
  void add(const Row& slopes, double weight, double value);

  // False where nothing tells some of the numbers.
  [[nodiscard]] bool solve(std::span<double> numbers) const;

 private:
  std::size_t numbers_;
  std::array<Row, kMaxNumbers> squares_{};
  Row values_{};
};

}  // namespace nutik::motion
