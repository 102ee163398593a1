#include "media/events/event_light.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "capture/format.hpp"
#include "capture/light_codes.hpp"
#include "capture/memory_needs.hpp"
#include "media/settled_fact.hpp"

namespace nutik {
namespace {

// Most sensors' thresholds are set to 0.1 … 0.3. Mid-grey leaves room for eight such steps up, and for fifty down.
constexpr Contrast kDefaultContrast{0.2, 0.2};
constexpr double kMidGrey = 0.18;
constexpr std::int64_t kEventUnitNs = 1000;

// The light of each pixel of a picture, which has to be of the wanted size.
std::vector<double> light_of_picture(const std::filesystem::path& path, const Shape& wanted) {
  const std::unique_ptr<Clip> clip = open_clip(path, {});
  refuse_left_out(path.string(), clip->info().left_out);
  const CaptureFormat& picture = clip->info().format;
  const Shape& shape = picture.shape;
  if (shape.width != wanted.width || shape.height != wanted.height) {
    throw InputError(format("{} has {} x {} pixels, and the recording {} x {}; the picture at its start must "
                            "show the same pixels",
                            path.string(), shape.width, shape.height, wanted.width, wanted.height),
                     {Setting::start_picture});
  }
  std::vector<std::byte> raster(picture.sample_bytes());
  if (!clip->read(raster)) throw InputError(format("{} has no picture", path.string()));
  const LightCodes codes(picture.transfer, picture.white_code);
  const auto light_at = [&](std::uint64_t value) {
    std::uint16_t code = 0;
    std::memcpy(&code, raster.data() + value * picture.code_bytes, picture.code_bytes);
    return codes.light_of(std::min<std::uint32_t>(code, picture.white_code));
  };
  std::vector<double> light(shape.pixel_count());
  for (std::uint64_t pixel = 0; pixel < light.size(); ++pixel) {
    if (shape.channels == 1) {
      light[pixel] = light_at(pixel);
      continue;
    }
    for (std::uint64_t channel = 0; channel < 3; ++channel) {
      light[pixel] += kLuma[channel] * light_at(3 * pixel + channel);
    }
  }
  return light;
}

std::string contrast_text(const Contrast& contrast) {
  if (contrast.up == contrast.down) return format("an event is {} of log light", contrast.up);
  return format("an event is {} of log light up, {} down", contrast.up, contrast.down);
}

// How far light went off, for events only tell differences.
Note drift_note(const CameraEvents& recording, const Contrast& contrast, std::uint64_t active,
                std::uint64_t above_white) {
  std::uint64_t up = 0;
  for (const CameraEvent& event : recording.events) up += event.is_up ? 1 : 0;
  const std::uint64_t down = recording.events.size() - up;
  const double drift =
      (contrast.up * static_cast<double>(up) - contrast.down * static_cast<double>(down)) /
      static_cast<double>(active);
  std::string text = format(
      "{} events up and {} down, of {} pixels, whose light ends at {:.3g} times what it was in the mean "
      "(geometric): steps that are not quite those of the sensor add up to a drift",
      up, down, active, std::exp(drift));
  if (above_white > 0) text += format("; {} pixels become brighter than white, which holds them", above_white);
  return {std::move(text), {Setting::contrast, Setting::start_picture}};
}

}  // namespace

void check_picture_size(const Shape& shape, std::uint64_t events, const std::string& name) {
  constexpr std::uint64_t kValuesOfAnySensor = 1 << 22, kValuesOfAnEvent = 16;
  constexpr std::uint64_t kMaxValues = std::uint64_t{1} << 32;  // they are counted in 32 bits
  if (shape.value_count() <= kValuesOfAnySensor ||
      (shape.value_count() <= kMaxValues && shape.value_count() / kValuesOfAnEvent <= events)) {
    return;
  }
  throw InputError(format("{} has {} x {} pixels by its header, and {} events: one of the two is wrong", name,
                          shape.width, shape.height, events));
}

void check_event_memory(const EventSizes& sizes, const Shape& shape, const ClipOptions& options) {
  if (!options.decoder_bytes) return;
  // Two numbers of each value, whether it was seen, and its codes at the start and by now.
  constexpr std::uint64_t kValueBytes = 2 * sizeof(double) + 1 + 2 * sizeof(std::uint16_t);
  const MemoryNeeds needs{
      {"events as they are read", sizes.events * sizes.event_bytes},
      {"what changes with each moment", ChangedSamples::bytes_of(sizes.events, sizes.samples)},
      {"light of its pixels", shape.value_count() * kValueBytes}};
  needs.rest_of(*options.decoder_bytes);
}

EventLight light_of_events(const CameraEvents& recording, const std::string& name, const ClipOptions& options,
                           ClipInfo& info) {
  CaptureFormat& capture = info.format;
  capture.shape = {recording.width, recording.height, 1};
  check_picture_size(capture.shape, recording.events.size(), name);
  capture.code_bytes = 2;
  capture.white_code = 65'535;
  if (options.white_code) {
    throw UsageError(format("{} holds events and no codes, of which one could be white", name),
                     {Setting::white_code});
  }
  describe_stored_codes(info, options, {Transfer::linear(), Transfer::linear(), {}, "how events are held"});

  Fact sensor{format("{}, {} x {}", recording.kind, recording.width, recording.height), Origin::file,
              Setting::tick};
  if (!recording.size_from.empty()) sensor.source = recording.size_from;
  info.facts.push_back(std::move(sensor));
  info.roundings.add(0.5, 1.0, "events");
  const std::uint64_t pixels = capture.shape.pixel_count();
  const Contrast contrast = settle(info.facts, options.events.contrast, std::optional<Contrast>(),
                                   kDefaultContrast, Setting::contrast, contrast_text);
  std::vector<double> start(pixels, kMidGrey);
  std::string started = format("light {} at the start", kMidGrey);
  if (options.events.start) {
    if (const auto* light = std::get_if<double>(&*options.events.start)) {
      start.assign(pixels, *light);
      started = format("light {} at the start", *light);
    } else {
      const auto& picture = std::get<std::filesystem::path>(*options.events.start);
      start = light_of_picture(picture, capture.shape);
      started = format("light of {} at the start", picture.filename().string());
    }
  }
  info.facts.push_back({std::move(started), options.events.start ? Origin::stated : Origin::assumed,
                        Setting::start_picture});

  const LightCodes codes(capture.transfer, capture.white_code);
  EventLight result{std::vector<std::uint16_t>(pixels),
                    ChangedSamples(options.events.tick_ns.value_or(kEventUnitNs))};
  // From no light at all no number of steps leads anywhere: half a code is the least.
  const double least = codes.light_of(1) / 2;
  std::vector<double> logs(pixels);
  for (std::uint64_t pixel = 0; pixel < pixels; ++pixel) {
    logs[pixel] = std::log(std::max(start[pixel], least));
    result.start[pixel] = static_cast<std::uint16_t>(codes.code_of(std::min(std::exp(logs[pixel]), 1.0)));
  }
  enum : std::uint8_t { kStill = 0, kActive = 1, kAboveWhite = 2 };
  std::vector<std::uint8_t> seen(pixels, kStill);
  const std::int64_t origin_us = recording.events.front().time_us;
  const auto time_ns = [&](const CameraEvent& event) { return (event.time_us - origin_us) * kEventUnitNs; };
  const std::uint64_t samples = count_samples(result.samples, recording.events, time_ns);
  check_event_memory({sizeof(CameraEvent), recording.events.size(), samples}, capture.shape, options);
  result.samples.reserve(recording.events.size(), samples);
  for (const CameraEvent& event : recording.events) {
    const std::uint64_t pixel = std::uint64_t{event.y} * recording.width + event.x;
    logs[pixel] += event.is_up ? contrast.up : -contrast.down;
    const double light = std::exp(logs[pixel]);
    seen[pixel] |= light > 1 ? kActive | kAboveWhite : kActive;
    const auto code = static_cast<std::uint16_t>(codes.code_of(std::min(light, 1.0)));
    result.samples.add(time_ns(event), {static_cast<std::uint32_t>(pixel), {code}});
  }
  result.end_ns = (recording.events.back().time_us - origin_us + 1) * kEventUnitNs;
  const auto count = [&](std::uint8_t of) {
    return static_cast<std::uint64_t>(std::ranges::count_if(seen, [of](std::uint8_t is) { return is & of; }));
  };
  info.facts.push_back(
      {format("time 0 at {} us of the camera's clock", origin_us), Origin::file, Setting::tick});
  info.notes.push_back(drift_note(recording, contrast, count(kActive), count(kAboveWhite)));
  return result;
}

}  // namespace nutik
