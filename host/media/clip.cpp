#include "media/clip.hpp"

#include <system_error>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/module.hpp"

namespace nutik {

std::unique_ptr<Clip> open_clip(const std::filesystem::path& path, const ClipOptions& options) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw InputError(format("{} cannot be read: no such file", path.string()));
  }
  if (std::filesystem::is_directory(status)) {
    throw InputError(format("{} is a folder, not a clip", path.string()));
  }
  return load_video_module()(path, options);
}

Timeline timeline_of(const ClipInfo& info, const ClipOptions& options, Rational shutter_angle,
                     std::uint64_t sample_count) {
  if (options.rate) return Timeline::constant(*options.rate, shutter_angle, sample_count);
  if (info.timing.rate) return Timeline::constant(*info.timing.rate, shutter_angle, sample_count);
  if (info.timing.starts_ns.size() < sample_count) {
    throw InputError(format("the clip has {} pictures but only {} times; state its rate with --fps",
                            sample_count, info.timing.starts_ns.size()));
  }
  return Timeline::irregular({info.timing.starts_ns.begin(),
                              info.timing.starts_ns.begin() + static_cast<std::ptrdiff_t>(sample_count)},
                             shutter_angle);
}

}  // namespace nutik
