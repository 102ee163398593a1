// 8-bit colour video through OpenCV, which decodes on all cores and hands out BGR.
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/clips/clips.hpp"

namespace nutik::clips {
namespace {

class OpenCvClip final : public Clip {
 public:
  OpenCvClip(const std::filesystem::path& path, const Probe& probe) : name_(path.string()) {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    if (!capture_.open(name_, cv::CAP_FFMPEG) || !capture_.read(frame_) || frame_.empty()) {
      throw InputError(format("{}: its first picture cannot be decoded", name_));
    }
    info_.format.shape = {static_cast<std::uint32_t>(frame_.cols), static_cast<std::uint32_t>(frame_.rows),
                          3};
    info_.format.transfer = Transfer::srgb();
    info_.timing = probe.timing;
    info_.sample_count = probe.sample_count;
    info_.notes = probe.notes;
  }

  [[nodiscard]] const ClipInfo& info() const override { return info_; }

  bool read(std::span<std::byte> raster) override {
    if (!has_frame_ && !capture_.read(frame_)) return false;
    has_frame_ = false;
    const Shape& shape = info_.format.shape;
    if (frame_.cols != static_cast<int>(shape.width) || frame_.rows != static_cast<int>(shape.height) ||
        frame_.type() != CV_8UC3) {
      throw InputError(format("{}: picture {} has {} x {} pixels, the ones before it {} x {}", name_,
                              frames_read_, frame_.cols, frame_.rows, shape.width, shape.height));
    }
    cv::Mat rgb(frame_.rows, frame_.cols, CV_8UC3, raster.data());
    cv::cvtColor(frame_, rgb, cv::COLOR_BGR2RGB);
    ++frames_read_;
    return true;
  }

 private:
  std::string name_;
  ClipInfo info_;
  cv::VideoCapture capture_;
  cv::Mat frame_;
  bool has_frame_ = true;  // the first was decoded to learn its size
  std::uint64_t frames_read_ = 0;
};

}  // namespace

std::unique_ptr<Clip> open_with_opencv(const std::filesystem::path& path, const Probe& probe) {
  return std::make_unique<OpenCvClip>(path, probe);
}

}  // namespace nutik::clips
