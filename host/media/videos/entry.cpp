// What nutik-videos.so gives the program (media/module.hpp).
#include "media/module.hpp"
#include "media/videos/libav.hpp"
#include "media/videos/videos.hpp"

namespace nutik::videos {
namespace {

std::unique_ptr<Clip> open_video_clip(const std::filesystem::path& path, const ClipOptions& options) {
  av_log_set_level(AV_LOG_FATAL);  // what matters is thrown, and said once
  return open_with_libav(path, probe(path, options.raw), options);
}

}  // namespace
}  // namespace nutik::videos

extern "C" __attribute__((visibility("default"))) const nutik::VideoModule nutik_video_module{
    nutik::use_shared_state, nutik::videos::open_video_clip, nutik::videos::open_libav_writer};
