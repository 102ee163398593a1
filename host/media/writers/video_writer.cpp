#include "media/writers/video_writer.hpp"

#include <algorithm>
#include <array>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/formats/extension.hpp"
#include "media/module.hpp"
#include "media/formats/numbered_name.hpp"

namespace nutik {
namespace {

constexpr std::array<VideoCodec, 6> kCodecs{{
    {"ffv1", "ffv1", " .mkv .avi ", true, true, true, 130, false},
    {"h264", "libx264", " .mp4 .m4v .mov .mkv ", true, false, false, 110, true},
    {"h265", "libx265", " .mp4 .m4v .mov .mkv ", true, false, false, 130, true},
    {"vp9", "libvpx-vp9", " .webm .mkv ", true, false, false, 110, true},
    {"prores", "prores_ks", " .mov .mkv ", false, true, false, 40, true},
    {"mjpeg", "mjpeg", " .avi .mov .mkv ", true, false, false, 16, true},
}};

struct Container {
  std::string_view extension;
  std::string_view default_codec;
};

constexpr std::array<Container, 6> kContainers{{{".mp4", "h264"},
                                                {".m4v", "h264"},
                                                {".mov", "h264"},
                                                {".mkv", "ffv1"},
                                                {".avi", "ffv1"},
                                                {".webm", "vp9"}}};

const Container* find_container(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  const auto found = std::find_if(kContainers.begin(), kContainers.end(), [&](const Container& container) {
    return container.extension == extension;
  });
  return found == kContainers.end() ? nullptr : &*found;
}

// ` .mkv ` is looked for in ` .mkv .avi `, so that no extension is part of another.
bool is_held(const VideoCodec& codec, std::string_view extension) {
  return codec.containers.find(format(" {} ", extension)) != std::string_view::npos;
}

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

double largest_rate_for(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  const bool is_coarse = extension == ".mkv" || extension == ".webm" || extension == ".avi";
  return is_coarse ? 1000.0 : 100'000.0;
}

const VideoCodec& video_codec_for(const std::filesystem::path& path, const std::optional<std::string>& name) {
  const Container* container = find_container(path);
  if (container == nullptr) {
    throw UsageError(
        format("{}: videos are written as .mp4, .m4v, .mov, .mkv, .avi or .webm, or as numbered "
               "stills, frame-%05d.png",
               path.string()));
  }
  std::string all, fitting;
  for (const VideoCodec& codec : kCodecs) {
    const bool held = is_held(codec, container->extension);
    if (held && codec.name == name.value_or(std::string(container->default_codec))) return codec;
    all += format("{}{}", all.empty() ? "" : ", ", codec.name);
    if (held) fitting += format("{}{}", fitting.empty() ? "" : ", ", codec.name);
  }
  const bool known = std::any_of(kCodecs.begin(), kCodecs.end(),
                                 [&](const VideoCodec& codec) { return codec.name == *name; });
  if (!known) throw UsageError(format("video codec '{}' is not known; choose one of: {}", *name, all));
  throw UsageError(
      format("{}: a {} file holds {}, not {}", path.string(), container->extension, fitting, *name));
}

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
