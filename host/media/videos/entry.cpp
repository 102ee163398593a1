// What nutik-videos.so gives the program (media/module.hpp).
#include "media/module.hpp"
#include "media/videos/damage_log.hpp"
#include "media/videos/videos.hpp"

namespace nutik::videos {
namespace {

std::unique_ptr<Clip> open_video_clip(const std::filesystem::path& path, const ClipOptions& options) {
  listen_to_ffmpeg();
  return open_with_libav(path, probe(path, options.raw), options);
}

}  // namespace
}  // namespace nutik::videos

extern "C" __attribute__((visibility("default"))) const nutik::VideoModule nutik_video_module{
    nutik::use_shared_state, nutik::videos::open_video_clip, nutik::videos::open_libav_writer};

extern "C" __attribute__((visibility("default"))) const char nutik_module_version[] = NUTIK_VERSION;
