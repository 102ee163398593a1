#include "media/writers/video_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/formats/extension.hpp"
#include "media/formats/numbered_name.hpp"
#include "media/module.hpp"

namespace nutik {
namespace {

// The best of 8-bit H.264 would lose nothing, in a profile that few players and editors open.
constexpr CodecScale kH264{"crf", 1, 51, 17}, kX264{"crf", 0, 51, 17}, kAom{"crf", 0, 63, 20}, kVpx{"crf", 0, 63, 17};
constexpr CodecScale kMjpeg{"qscale", 2, 31, 2}, kWebp{"quality", 100, 0, 90}, kNone{};

constexpr VideoCodec kCodecs[] = {
    {"ffv1", "ffv1", " .mkv .avi ", true, true, true, 130, false, "", kNone, "level=3:slicecrc=1"},
    {"h264", "libx264", " .mp4 .m4v .mov .mkv ", true, false, false, 110, true, "yuv420p", kH264},
    {"h264-10", "libx264", " .mp4 .m4v .mov .mkv ", false, true, false, 110, true, "yuv420p10le", kX264},
    {"h265", "libx265", " .mp4 .mov .mkv ", true, false, false, 130, true, "yuv420p", kX264,
     "x265-params=log-level=none"},
    {"h265-10", "libx265", " .mp4 .mov .mkv ", false, true, false, 130, true, "yuv420p10le", kX264,
     "x265-params=log-level=none"},
    {"av1", "libaom-av1", " .mp4 .mkv .webm ", true, false, false, 130, true, "yuv420p", kAom,
     "row-mt=1:cpu-used=6"},
    {"av1-10", "libaom-av1", " .mp4 .mkv .webm ", false, true, false, 130, true, "yuv420p10le", kAom,
     "row-mt=1:cpu-used=6"},
    {"vp9", "libvpx-vp9", " .webm .mkv ", true, false, false, 110, true, "yuv420p", kVpx,
     "row-mt=1:cpu-used=4"},
    {"prores", "prores_ks", " .mov .mkv ", false, true, false, 40, true, "yuv422p10le", kNone, "profile=hq"},
    {"prores-proxy", "prores_ks", " .mov .mkv ", false, true, false, 40, true, "yuv422p10le", kNone,
     "profile=proxy"},
    {"prores-lt", "prores_ks", " .mov .mkv ", false, true, false, 40, true, "yuv422p10le", kNone,
     "profile=lt"},
    {"prores-422", "prores_ks", " .mov .mkv ", false, true, false, 40, true, "yuv422p10le", kNone,
     "profile=standard"},
    {"prores-4444", "prores_ks", " .mov .mkv ", false, true, false, 40, true, "yuv444p10le", kNone,
     "profile=4444"},
    {"dnxhr-lb", "dnxhd", " .mov .mxf ", true, false, false, 40, true, "yuv422p", kNone, "profile=dnxhr_lb"},
    {"dnxhr-sq", "dnxhd", " .mov .mxf ", true, false, false, 40, true, "yuv422p", kNone, "profile=dnxhr_sq"},
    {"dnxhr-hq", "dnxhd", " .mov .mxf ", true, false, false, 40, true, "yuv422p", kNone, "profile=dnxhr_hq"},
    {"dnxhr-hqx", "dnxhd", " .mov .mxf ", false, true, false, 40, true, "yuv422p10le", kNone,
     "profile=dnxhr_hqx"},
    {"dnxhr-444", "dnxhd", " .mov .mxf ", false, true, false, 40, true, "yuv444p10le", kNone,
     "profile=dnxhr_444"},
    {"mjpeg", "mjpeg", " .avi .mov .mkv ", true, false, false, 16, true, "yuvj420p", kMjpeg},
    {"gif", "gif", " .gif ", true, false, false, 16, false, "pal8", kNone},
    {"webp", "libwebp_anim", " .webp ", true, false, false, 16, true, "yuv420p", kWebp},
};

struct Container {
  std::string_view extension;
  std::string_view default_codec;
};

constexpr std::array<Container, 9> kContainers{{{".mp4", "h264"},
                                                {".m4v", "h264"},
                                                {".mov", "h264"},
                                                {".mkv", "ffv1"},
                                                {".avi", "ffv1"},
                                                {".webm", "vp9"},
                                                {".mxf", "dnxhr-hqx"},
                                                {".gif", "gif"},
                                                {".webp", "webp"}}};

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
  if (extension == ".gif") return 50.0;  // players wait longer for less than two hundredths
  const bool is_coarse =
      extension == ".mkv" || extension == ".webm" || extension == ".avi" || extension == ".webp";
  return is_coarse ? 1000.0 : 100'000.0;
}

const VideoCodec& video_codec_for(const std::filesystem::path& path, const std::optional<std::string>& name) {
  const Container* container = find_container(path);
  if (container == nullptr) {
    throw UsageError(
        format("{}: videos are written as .mp4, .m4v, .mov, .mxf, .mkv, .avi, .webm, .gif or .webp, or as "
               "numbered stills, frame-%05d.png",
               path.string()));
  }
  if (NumberedName::parse(path.filename().string()))
    throw UsageError(format("{}: a {} holds all frames in one file; leave the number out of its name", path.string(),
                            container->extension));
  std::string all, fitting;
  for (const VideoCodec& codec : kCodecs) {
    const bool held = is_held(codec, container->extension);
    if (held && codec.name == name.value_or(std::string(container->default_codec))) return codec;
    all += format("{}{}", all.empty() ? "" : ", ", codec.name);
    if (held) fitting += format("{}{}", fitting.empty() ? "" : ", ", codec.name);
  }
  const bool known = std::ranges::find(kCodecs, *name, &VideoCodec::name) != std::end(kCodecs);
  if (!known) throw UsageError(format("video codec '{}' is not known; choose one of: {}", *name, all));
  throw UsageError(
      format("{}: a {} file holds {}, not {}", path.string(), container->extension, fitting, *name));
}

std::span<const VideoCodec> video_codecs() { return kCodecs; }

int codec_setting(const VideoCodec& codec, const std::optional<std::uint32_t>& crf,
                  const std::optional<std::uint32_t>& quality) {
  const CodecScale& scale = codec.scale;
  if (!crf && !quality) return scale.usual;
  if (crf && quality) {
    throw UsageError("both say how good the film is to be, on two scales; state one", {Setting::crf, Setting::quality});
  }
  if (scale.key.empty()) {
    throw UsageError(
        format("{} has no scale of quality{}", codec.name,
               codec.is_lossless ? ": it loses nothing" : "; choose another of its kind, by its name"),
        {crf ? Setting::crf : Setting::quality});
  }
  if (crf) {
    const auto [least, most] = std::minmax(scale.best, scale.worst);
    if (static_cast<int>(*crf) >= least && static_cast<int>(*crf) <= most) return static_cast<int>(*crf);
    throw UsageError(format("{}'s own scale runs from {} (best) to {}, and {} is outside", codec.name,
                            scale.best, scale.worst, *crf),
                     {Setting::crf});
  }
  const double share = (100.0 - *quality) / 99.0;  // of the way from best to worst
  return static_cast<int>(std::lround(scale.best + share * (scale.worst - scale.best)));
}

std::unique_ptr<VideoWriter> open_video_writer(const std::filesystem::path& path, const VideoFormat& format,
                                               const VideoCodec& codec) {
  return video_module().open_writer(path, format, codec);
}

ValueType video_value_type(const VideoCodec& codec, std::optional<Depth> wish, ValueType usual) {
  if (wish && *wish != Depth::bits8 && *wish != Depth::bits16) {
    throw UsageError("a video holds no floating point; write numbered stills: frame-%05d.exr or .tif");
  }
  if (wish == Depth::bits16 && !codec.holds_16_bits) {
    throw UsageError(
        format("{} holds 8 bits; for 16 use ffv1 in a .mkv, or numbered stills; for 10 one of the codecs "
               "that say so: h264-10, h265-10, av1-10, prores, dnxhr-hqx",
               codec.name),
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
