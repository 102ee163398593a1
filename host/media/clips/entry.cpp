// What nutik-clips.so gives the program (media/module.hpp).
#include "media/clips/clips.hpp"
#include "media/clips/libav.hpp"
#include "media/module.hpp"

namespace nutik::clips {
namespace {

std::unique_ptr<Clip> open_video_clip(const std::filesystem::path& path, const ClipOptions& options) {
  av_log_set_level(AV_LOG_FATAL);  // what matters is thrown, and said once
  const Probe found = probe(path, options.raw);
  const bool plain = found.pixels.bits <= 8 && !found.pixels.is_grey && !options.raw;
  return plain ? open_with_opencv(path, found) : open_with_libav(path, found, options);
}

}  // namespace
}  // namespace nutik::clips

extern "C" __attribute__((visibility("default")))
const nutik::ClipModule nutik_clip_module{nutik::clips::open_video_clip, nutik::clips::open_still_files,
                                          nutik::clips::read_exif_times, nutik::clips::open_libav_writer};
