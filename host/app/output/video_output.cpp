#include "app/output/video_output.hpp"

#include "app/output/output_name.hpp"
#include "app/requests/output_words.hpp"
#include "session/error.hpp"
#include "session/format.hpp"
#include "session/pictures.hpp"

namespace nutik::app {

VideoOutput::VideoOutput(const Options& options, std::filesystem::path path, Rational rate)
    : options_(options), path_(std::move(path)), rate_(rate) {
  const bool is_numbered = NumberedName::parse(path_.filename().string()).has_value();
  if (is_picture_name(path_) && is_numbered) {
    if (options.video_codec) {
      throw UsageError(format("--video-codec goes with a video in one file; {} are stills", path_.string()));
    }
    return;
  }
  if (is_picture_name(path_)) {
    throw UsageError(format("{} is one picture and a video has many; number them: {}-%05d{}", path_.string(),
                            (path_.parent_path() / path_.stem()).string(), path_.extension().string()));
  }
  codec_ = &video_codec_for(path_, options.video_codec);
  if (const double largest = largest_rate_for(path_); rate.value() > largest) {
    throw UsageError(
        format("{}: a {} file tells at most {:.0f} frames a second apart, and {} are asked for; write {}",
               path_.string(), path_.extension().string(), largest, rate.text(),
               largest < 100'000 ? "a .mp4 or .mov, or numbered stills" : "numbered stills"));
  }
}

OutputFormat VideoOutput::frame_format(const CaptureFormat& capture) const {
  if (codec_ == nullptr) return output_format(output_request(options_), path_, capture);
  const OutputRequest request = output_request(options_);
  const ValueType usual = code_type(capture);
  OutputFormat output;
  output.type = video_value_type(*codec_, request.depth, usual);
  output.white_code = output.type == ValueType::code8 ? 255 : 65'535;  // what players take for white
  output.negative = negative_light(request, output.type, path_);
  return output;
}

void VideoOutput::check(std::uint64_t frames, std::span<const std::string> inputs) const {
  if (codec_ != nullptr) {
    check_output(path_, OutputKind::video, inputs);
    return;
  }
  const NumberedName name = NumberedName::parse(path_.filename().string()).value();
  std::error_code error;
  for (std::uint64_t k = 0; k < frames; ++k) {
    // What is not there yet can be no input.
    const std::filesystem::path still = path_.parent_path() / name.with(k);
    if (std::filesystem::exists(still, error)) check_output(still, OutputKind::picture, inputs);
  }
}

std::unique_ptr<VideoWriter> VideoOutput::open(const Shape& shape, const OutputFormat& format,
                                               const Transfer& transfer) const {
  if (codec_ == nullptr) return open_still_writer(path_);
  return open_video_writer(path_, {shape, format.type, format.white_code, transfer, rate_}, *codec_);
}

std::string VideoOutput::kind() const { return codec_ == nullptr ? "stills" : std::string(codec_->name); }

}  // namespace nutik::app
