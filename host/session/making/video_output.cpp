#include "session/making/video_output.hpp"

#include <utility>

#include "capture/format.hpp"
#include "media/formats/numbered_name.hpp"
#include "system/is_absent.hpp"

namespace nutik {

VideoOutput::VideoOutput(std::filesystem::path path, Rational rate, const std::optional<std::string>& codec,
                         const OutputRequest& request)
    : path_(std::move(path)), rate_(rate), request_(request) {
  if (names_standard_output(path_)) {
    throw UsageError(
        format("{} is standard output, and a video is written to a file: what makes it goes back in it",
               path_.string()));
  }
  const bool is_numbered = NumberedName::parse(path_.filename().string()).has_value();
  if (is_picture_name(path_) && is_numbered) {
    if (codec) {
      throw UsageError(format("a video's codec goes with a video in one file; {} are stills", path_.string()),
                       {Setting::video_codec});
    }
    return;
  }
  if (is_picture_name(path_)) {
    throw UsageError(format("{} is one picture and a video has many; number them: {}-%05d{}", path_.string(),
                            (path_.parent_path() / path_.stem()).string(), path_.extension().string()));
  }
  codec_ = &video_codec_for(path_, codec);
  if (const double largest = largest_rate_for(path_); rate.value() > largest) {
    throw UsageError(
        format("{}: a {} file tells at most {:.0f} frames a second apart, and {} are asked for; write {}",
               path_.string(), path_.extension().string(), largest, rate.text(),
               largest < 100'000 ? "a .mp4 or .mov, or numbered stills" : "numbered stills"));
  }
}

OutputFormat VideoOutput::frame_format(const CaptureFormat& capture) const {
  if (codec_ == nullptr) return output_format(request_, path_, capture);
  OutputFormat output =
      output_format(request_, path_, video_value_type(*codec_, request_.depth, code_type(capture)), capture);
  output.white_code = output.type == ValueType::code8 ? 255 : 65'535;  // what players take for white
  return output;
}

void VideoOutput::check(std::span<const std::uint64_t> frames, std::span<const std::string> inputs,
                        Replacing replacing) const {
  if (codec_ != nullptr) {
    check_output(path_, OutputKind::video, inputs, replacing);
    return;
  }
  for (const std::uint64_t frame : frames) {
    // What is not there yet can be no input.
    if (!is_absent(still(frame))) check_output(still(frame), OutputKind::picture, inputs, replacing);
  }
}

std::filesystem::path VideoOutput::still(std::uint64_t frame) const {
  return path_.parent_path() / NumberedName::parse(path_.filename().string()).value().with(frame);
}

std::unique_ptr<VideoWriter> VideoOutput::open(const CaptureFormat& capture,
                                               const OutputFormat& format) const {
  if (codec_ == nullptr) return open_still_writer(path_, file_wishes(request_));
  const CodeMaking making = CodeMaking::of(capture, format);
  return open_video_writer(path_,
                           {capture.shape, format.type, format.white_code, making.transfer, rate_,
                            making.primaries, capture.pixel_aspect},
                           *codec_);
}

std::string VideoOutput::kind() const { return writes_stills() ? "stills" : std::string(codec_->name); }

}  // namespace nutik
