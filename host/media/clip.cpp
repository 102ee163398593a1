#include "media/clip.hpp"

#include <system_error>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/module.hpp"
#include "media/still_sequence.hpp"

namespace nutik {

std::unique_ptr<Clip> open_clip(const std::filesystem::path& path, const ClipOptions& options) {
  if (!options.raw) {
    if (const auto stills = list_stills(path)) return load_clip_module().open_stills(*stills, options);
  }
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw InputError(format("{} cannot be read: no such file", path.string()));
  }
  return load_clip_module().open_video(path, options);
}

Timeline timeline_of(const std::string& name, const ClipInfo& info, const ClipOptions& options,
                     Rational shutter_angle, std::uint64_t sample_count) {
  if (options.rate) return Timeline::constant(*options.rate, shutter_angle, sample_count);
  if (!info.timing.rate && info.timing.starts_ns.empty()) {
    throw InputError(format("{} does not say how fast it was taken; state the rate with --fps", name));
  }
  if (info.timing.rate) return Timeline::constant(*info.timing.rate, shutter_angle, sample_count);
  if (info.timing.starts_ns.size() < sample_count) {
    throw InputError(format("{} has {} pictures but only {} times; state its rate with --fps", name,
                            sample_count, info.timing.starts_ns.size()));
  }
  try {
    return Timeline::irregular({info.timing.starts_ns.begin(),
                                info.timing.starts_ns.begin() + static_cast<std::ptrdiff_t>(sample_count)},
                               shutter_angle);
  } catch (const InputError& error) {
    throw InputError(format("{}: {}", name, error.what()));
  }
}

}  // namespace nutik
