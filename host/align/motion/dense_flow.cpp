// Dense inverse search (Kroeger, Timofte, Dai and Van Gool, "Fast Optical Flow using Dense Inverse Search"), refined by
// variations, as OpenCV has it.
#include "align/motion/dense_flow.hpp"

#include <cmath>
#include <opencv2/video/tracking.hpp>

namespace nutik::motion {
namespace {

// Small pictures are searched at their own size, larger ones at the level with no more pixels than the second: 1080p at
// a quarter of its sides, for a fourth of the time at half of them.
constexpr double kSmallPixels = 500'000, kFinestPixels = 250'000;

class DenseFlow final : public FlowFinder {
 public:
  // What a patch finds depends on which strip of the picture it is in, and each thread has one.
  DenseFlow() : search_(cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_MEDIUM)) {
    search_->setVariationalRefinementIterations(2);  // three quarters of the time of 5, as good within a hundredth
    cv::setNumThreads(1);
  }

  void find(const GreyPlane& from, const GreyPlane& to, std::span<FlowVector> flow) override {
    const double pixels = static_cast<double>(from.width) * from.height;
    const bool is_small = pixels <= kSmallPixels;
    search_->setFinestScale(is_small ? 0 : static_cast<int>(std::ceil(std::log2(pixels / kFinestPixels) / 2)));
    cv::Mat found(static_cast<int>(from.height), static_cast<int>(from.width), CV_32FC2, flow.data());
    search_->calc(mat(from), mat(to), found);
    if (found.ptr() != reinterpret_cast<const unsigned char*>(flow.data())) {
      found.copyTo(cv::Mat(found.rows, found.cols, CV_32FC2, flow.data()));
    }
  }

 private:
  // The search wants rows without gaps.
  static cv::Mat mat(const GreyPlane& plane) {
    return cv::Mat(static_cast<int>(plane.height), static_cast<int>(plane.width), CV_8U,
                   const_cast<std::uint8_t*>(plane.pixels), plane.stride)
        .clone();
  }

  cv::Ptr<cv::DISOpticalFlow> search_;
};

}  // namespace

std::unique_ptr<FlowFinder> open_dense_flow() { return std::make_unique<DenseFlow>(); }

}  // namespace nutik::motion
