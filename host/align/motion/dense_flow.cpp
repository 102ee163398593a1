// Dense inverse search (Kroeger, Timofte, Dai and Van Gool, "Fast Optical Flow using Dense Inverse Search"), refined by
// variations, as OpenCV has it.
#include <cmath>
#include <memory>
#include <opencv2/video/tracking.hpp>

#include "align/flow.hpp"

namespace nutik::motion {
namespace {

// Refinement ends at the level with no more pixels than this: 1080p at a quarter of its sides, for a fourth of the time
// at half of them, 640 x 272 at half, pictures of 320 x 240 at their own.
constexpr double kFinestPixels = 130'000;

class DenseFlow final : public FlowFinder {
 public:
  // What a patch finds depends on which strip of the picture it is in, and each thread has one.
  DenseFlow() : search_(cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_MEDIUM)) {
    search_->setVariationalRefinementIterations(2);  // three quarters of the time of 5, as good within a hundredth
    // Once: it takes down the threads there are, and two finders may be opened at the same time.
    [[maybe_unused]] static const bool is_alone = (cv::setNumThreads(0), true);
  }

  void find(const GreyPlane& from, const GreyPlane& to, std::span<FlowVector> flow, Detail detail) override {
    const double pixels = static_cast<double>(from.width) * from.height;
    const int finest = static_cast<int>(std::max(0.0, std::ceil(std::log2(pixels / kFinestPixels) / 2)));
    search_->setFinestScale(finest + (detail == Detail::rough ? 2 : 0));
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
