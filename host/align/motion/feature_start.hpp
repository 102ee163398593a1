// About where a picture lies, by matched features: from any distance, to a pixel or so.
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <optional>
#include <vector>

#include "align/warp.hpp"

namespace nutik::motion {

class FeatureStart {
 public:
  // A pixel of `reference` is `scale` pixels of the original.
  FeatureStart(const cv::Mat& reference, double scale);

  // Finds a picture of the same size that was moved and turned, not scaled. Nothing where too few features agree.
  [[nodiscard]] std::optional<Warp> find(const cv::Mat& picture) const;

 private:
  static constexpr int kFeatures = 1500;
  cv::Ptr<cv::SIFT> detector_ = cv::SIFT::create(kFeatures);
  std::vector<cv::KeyPoint> points_;
  cv::Mat descriptors_;
  double scale_;
};

}  // namespace nutik::motion
