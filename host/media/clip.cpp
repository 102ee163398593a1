#include "media/clip.hpp"

#include <algorithm>
#include <system_error>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/module.hpp"
#include "media/still_sequence.hpp"
#include "media/stills_table.hpp"

namespace nutik {

namespace {

std::unique_ptr<Clip> open_table(const std::filesystem::path& path, const ClipOptions& options) {
  const StillModule& module = still_module();
  const std::vector<ListedStill> stills = read_stills_table(path);
  std::vector<std::filesystem::path> files;
  std::vector<StillTimes> exif;
  for (const ListedStill& still : stills) {
    files.push_back(still.file);
    const bool is_timed = still.times.start_ns && still.times.exposure_ns;
    exif.push_back(is_timed || options.rate ? StillTimes{} : module.read_exif_times(still.file));
  }
  return module.open(files, options.rate ? ClipTiming{} : timing_of(path, stills, exif), options);
}

// A clip of which there is more to tell than its module knows.
class NotedClip final : public Clip {
 public:
  NotedClip(std::unique_ptr<Clip> clip, std::string note) : clip_(std::move(clip)), info_(clip_->info()) {
    info_.notes.emplace_back(std::move(note));
  }

  [[nodiscard]] const ClipInfo& info() const override { return info_; }
  bool read(std::span<std::byte> raster) override { return clip_->read(raster); }

 private:
  std::unique_ptr<Clip> clip_;
  ClipInfo info_;
};

std::unique_ptr<Clip> open_stills(const std::filesystem::path& path,
                                  const std::vector<std::filesystem::path>& stills,
                                  const ClipOptions& options) {
  std::unique_ptr<Clip> clip = still_module().open(stills, {}, options);
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) return clip;
  auto note = missing_still_note(path, stills);
  return note ? std::make_unique<NotedClip>(std::move(clip), std::move(*note)) : std::move(clip);
}

}  // namespace

std::unique_ptr<Clip> open_clip(const std::filesystem::path& path, const ClipOptions& options) {
  if (!options.raw) {
    if (is_stills_table(path)) return open_table(path, options);
    if (const auto stills = list_stills(path)) return open_stills(path, *stills, options);
  }
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw InputError(format("{} cannot be read: no such file", path.string()));
  }
  return video_module().open(path, options);
}

Timeline timeline_of(const std::string& name, const ClipInfo& info, const ClipOptions& options,
                     Rational shutter_angle, std::uint64_t sample_count) {
  if (options.rate) return Timeline::constant(*options.rate, shutter_angle, sample_count);
  if (!info.timing.is_known()) {
    throw InputError(format("{} does not say how fast it was taken; state the rate", name),
                     {Setting::frame_rate});
  }
  if (info.timing.rate) {
    try {
      static_cast<void>(Timeline::constant(*info.timing.rate, Timeline::kFullShutter, sample_count));
    } catch (const UsageError& error) {  // nobody stated it
      throw InputError(format("{}: the rate in the file cannot be: {}; state another", name, error.what()),
                       {Setting::frame_rate});
    }
    return Timeline::constant(*info.timing.rate, shutter_angle, sample_count);
  }
  const std::size_t times = std::max(info.timing.starts_ns.size(), info.timing.exposures.size());
  if (times < sample_count) {
    throw InputError(
        format("{} has {} pictures but only {} times; state its rate", name, sample_count, times),
        {Setting::frame_rate});
  }
  try {
    if (!info.timing.exposures.empty()) {
      const auto& exposures = info.timing.exposures;
      return Timeline::explicit_exposures(
          {exposures.begin(), exposures.begin() + static_cast<std::ptrdiff_t>(sample_count)});
    }
    return Timeline::irregular({info.timing.starts_ns.begin(),
                                info.timing.starts_ns.begin() + static_cast<std::ptrdiff_t>(sample_count)},
                               shutter_angle);
  } catch (const InputError& error) {
    throw InputError(format("{}: {}", name, error.what()), error.settings());
  }
}

}  // namespace nutik
