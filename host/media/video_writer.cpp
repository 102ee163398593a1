#include "media/video_writer.hpp"

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/module.hpp"
#include "media/numbered_name.hpp"

namespace nutik {
namespace {

class StillWriter final : public VideoWriter {
 public:
  StillWriter(const std::filesystem::path& path, const FileWishes& wishes)
      : folder_(path.parent_path()),
        name_(NumberedName::parse(path.filename().string()).value()),
        wishes_(wishes) {}

  void write(const Picture& picture, const std::string& text, std::uint64_t number) override {
    write_picture(folder_ / name_.with(number), picture, text, wishes_);
  }
  void finish() override {}

 private:
  std::filesystem::path folder_;
  NumberedName name_;
  FileWishes wishes_;
};

}  // namespace

std::unique_ptr<VideoWriter> open_video_writer(const std::filesystem::path& path, const VideoFormat& format,
                                               const VideoCodec& codec) {
  return video_module().open_writer(path, format, codec);
}

std::unique_ptr<VideoWriter> open_still_writer(const std::filesystem::path& path, const FileWishes& wishes) {
  return std::make_unique<StillWriter>(path, wishes);
}

ValueType video_value_type(const VideoCodec& codec, std::optional<Depth> wish, ValueType usual) {
  if (wish == Depth::floating || wish == Depth::half) {
    throw UsageError("a video holds no floating point; write numbered stills: frame-%05d.exr or .tif");
  }
  if (wish == Depth::bits16 && !codec.holds_16_bits) {
    throw UsageError(format("{} holds 8 bits; for 16 use ffv1 in a .mkv, or numbered stills", codec.name),
                     {Setting::video_codec});
  }
  if (wish == Depth::bits8 && !codec.holds_8_bits) {
    throw UsageError(format("{} holds more than 8 bits; leave the depth out", codec.name), {Setting::depth});
  }
  if (wish) return *wish == Depth::bits8 ? ValueType::code8 : ValueType::code16;
  if (!codec.holds_16_bits) return ValueType::code8;
  return codec.holds_8_bits ? usual : ValueType::code16;
}

}  // namespace nutik
