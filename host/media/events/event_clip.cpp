#include "media/events/event_clip.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/events/event_light.hpp"
#include "media/events/prophesee_events.hpp"
#include "media/formats/file_kinds.hpp"
#include "media/formats/input_kinds.hpp"
#include "system/input_bytes.hpp"
#include "system/mapped_file.hpp"

namespace nutik {
namespace {

// A recording of light, ready to be read.
class EventClip final : public Clip {
 public:
  EventClip(ClipInfo info, EventLight light) : info_(std::move(info)), light_(std::move(light)) {
    held_ = light_.start;
    info_.timing.exposures = light_.samples.exposures(light_.end_ns);
    info_.sample_count = light_.samples.count();
    info_.decoder_bytes = light_.samples.bytes() + 2 * held_.size() * sizeof(std::uint16_t);
  }

  [[nodiscard]] const ClipInfo& info() const override { return info_; }

  bool read(std::span<std::byte> raster) override {
    if (!read_changes()) return false;
    std::memcpy(raster.data(), held_.data(), raster.size());
    return true;
  }

  [[nodiscard]] bool tells_changes() const override { return true; }
  [[nodiscard]] bool makes_codes() const override { return true; }

  std::optional<std::span<const PixelChange>> read_changes() override {
    if (next_ == light_.samples.count()) return std::nullopt;
    const auto changes = light_.samples.of(next_++);
    const std::size_t channels = info_.format.shape.channels;
    for (const PixelChange& change : changes) {
      std::memcpy(&held_[change.pixel * channels], change.codes.data(), channels * sizeof(std::uint16_t));
    }
    return changes;
  }

 private:
  ClipInfo info_;
  EventLight light_;
  std::vector<std::uint16_t> held_;
  std::uint64_t next_ = 0;
};

}  // namespace

bool is_event_recording(const std::filesystem::path& path) {
  const std::string start = telling_bytes(is_standard_input(path.string()) ? standard_input_file() : path);
  return std::ranges::any_of(inputs::kClips, [&](const auto* kind) { return kind->has_events && kind->begins(start); });
}

std::unique_ptr<Clip> open_event_clip(const std::filesystem::path& path, const ClipOptions& options) {
  const std::string name = input_title(path.string());
  if (!is_event_recording(path)) throw InputError(format("{} is no recording of events", name));
  if (options.rate) {
    throw UsageError(format("{} has times of its own at every pixel, and no rate", name), {Setting::frame_rate});
  }
  const MappedFile file(path);
  ClipInfo info;
  info.timing.rate_from = "the times of its events";
  if (inputs::kAdder.begins(first_bytes(path))) {
    EventLight light = read_adder_file(file.bytes(), name, options, info);
    return std::make_unique<EventClip>(std::move(info), std::move(light));
  }
  CameraEvents recording = read_prophesee_events(file.bytes(), name, options);
  info.notes = std::move(recording.notes);
  EventLight light = light_of_events(recording, name, options, info);
  return std::make_unique<EventClip>(std::move(info), std::move(light));
}

constexpr inputs::InputKind inputs::kProphesee{
    .name = "Prophesee", .starts = {"% "},
    .said = {"each event's", "until the next moment", "light from steps: 16 bits, linear", "none", "none", "by time"},
    .open = [](const auto& path, const auto&, const auto& options) { return open_event_clip(path, options); },
    .has_events = true};
constexpr inputs::InputKind inputs::kAdder{
    .name = "ADΔER", .starts = {"adder"},
    .said = {"each event's", "until the next moment", "light as told: 16 bits, linear, white by its source", "none",
             "none", "by time"},
    .open = kProphesee.open, .has_events = true};

}  // namespace nutik
