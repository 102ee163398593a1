#include "align/motion/feature_start.hpp"

#include <cmath>
#include <cstddef>
#include <opencv2/calib3d.hpp>

namespace nutik::motion {

FeatureStart::FeatureStart(const cv::Mat& reference, double scale) : scale_(scale) {
  detector_->detectAndCompute(reference, cv::noArray(), points_, descriptors_);
}

std::optional<Warp> FeatureStart::find(const cv::Mat& picture) const {
  constexpr float kMaxAlike = 0.8F;
  constexpr int kMinAgreeing = 12;
  constexpr double kAgreeingPixels = 3;
  std::vector<cv::KeyPoint> points;
  cv::Mat descriptors;
  detector_->detectAndCompute(picture, cv::noArray(), points, descriptors);
  if (descriptors.empty() || descriptors_.empty()) return std::nullopt;
  std::vector<std::vector<cv::DMatch>> matches;
  cv::BFMatcher(cv::NORM_L2).knnMatch(descriptors_, descriptors, matches, 2);
  std::vector<cv::Point2d> from, to;
  for (const std::vector<cv::DMatch>& two : matches) {
    // Only what looks like nothing else nearly as much.
    if (two.size() < 2 || two[0].distance > kMaxAlike * two[1].distance) continue;
    const cv::DMatch& match = two[0];
    from.push_back(scale_ * cv::Point2d(points_[static_cast<std::size_t>(match.queryIdx)].pt));
    to.push_back(scale_ * cv::Point2d(points[static_cast<std::size_t>(match.trainIdx)].pt));
  }
  if (from.size() < kMinAgreeing) return std::nullopt;
  std::vector<unsigned char> agrees;
  const cv::Mat similar = cv::estimateAffinePartial2D(from, to, agrees, cv::RANSAC, scale_ * kAgreeingPixels);
  if (similar.empty() || cv::countNonZero(agrees) < kMinAgreeing) return std::nullopt;
  // Its scale is left out, about the middle of what agrees.
  const double a = similar.at<double>(0, 0), b = similar.at<double>(1, 0), size = std::hypot(a, b);
  cv::Point2d from_middle, to_middle;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (agrees[i] == 0) continue;
    from_middle += from[i];
    to_middle += to[i];
  }
  from_middle *= 1.0 / cv::countNonZero(agrees);
  to_middle *= 1.0 / cv::countNonZero(agrees);
  const double c = a / size, s = b / size;
  return Warp{{c, -s, to_middle.x - c * from_middle.x + s * from_middle.y, s, c,
               to_middle.y - s * from_middle.x - c * from_middle.y, 0, 0, 1}};
}

}  // namespace nutik::motion
