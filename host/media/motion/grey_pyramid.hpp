// A picture as a registrar looks at it: grey, a little blurred, and smaller and smaller.
#pragma once

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

  // Of 8 bits, for features, and how many of the picture's pixels are one of its.
  [[nodiscard]] cv::Mat of_features() const;
  [[nodiscard]] double feature_scale() const;

  int finest = 0;  // the pixels of levels[0] are 2^finest of the picture's, of levels[1] twice as many
  std::vector<cv::Mat> levels;  // of floats; pixel (x, y) of each lies at a pixel of the one before

 private:
  std::vector<cv::Mat> greys_;  // before they are blurred, the picture itself first
};

}  // namespace nutik::motion
