// The entry point of nutik-video.so (media/module.hpp).
#include "media/module.hpp"
#include "media/video/clips.hpp"
#include "media/video/libav.hpp"

extern "C" __attribute__((visibility("default"))) std::unique_ptr<nutik::Clip> nutik_open_video(
    const std::filesystem::path& path, const nutik::ClipOptions& options) {
  av_log_set_level(AV_LOG_FATAL);  // what matters is thrown, and said once
  const nutik::video::Probe probe = nutik::video::probe(path);
  if (probe.bits <= 8 && !probe.is_grey) return nutik::video::open_with_opencv(path, probe);
  return nutik::video::open_with_libav(path, probe, options);
}

static_assert(std::is_same_v<decltype(&nutik_open_video), nutik::OpenVideo>);
