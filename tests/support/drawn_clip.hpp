// Clips that a test draws, picture by picture.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>

namespace nutik::test {

// Frames of a grey clip in a folder, each by its number.
class DrawnClip {
 public:
  explicit DrawnClip(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::filesystem::create_directory(folder_);
  }
  void add(const cv::Mat& frame) {
    cv::imwrite((folder_ / (std::to_string(1000 + count_++) + ".png")).string(), frame);
  }

 private:
  std::filesystem::path folder_;
  int count_ = 0;
};

// 160 x 96 pixels of a texture that no other number has.
inline cv::Mat ground_of(int number) {
  cv::Mat frame(96, 160, CV_8UC1);
  cv::RNG random(static_cast<std::uint64_t>(number + 1));
  for (int y = 0; y < frame.rows; y += 8) {
    for (int x = 0; x < frame.cols; x += 8) frame(cv::Rect(x, y, 8, 8)) = random.uniform(60, 160);
  }
  return frame;
}

}  // namespace nutik::test
