#include "media/video_codec.hpp"

#include <algorithm>
#include <array>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/extension.hpp"

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

}  // namespace nutik
