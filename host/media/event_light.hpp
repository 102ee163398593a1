// Light from the events of a contrast-detecting camera.
//
// Each event is a step of the logarithm of light at its pixel, up or down, from a light at the start:
//
//     light(t) = start · exp(up · n_up(t) − down · n_down(t))
//
// The logarithm is kept as it is; only the code that stands for light ends at white, so light that was above white comes
// back as it went. A code is that whose light is next: 16 bits, linear unless another transfer function is stated.
#pragma once

#include <string>
#include <vector>

#include "media/camera_events.hpp"
#include "media/changed_samples.hpp"
#include "media/clip.hpp"

namespace nutik {

struct EventLight {
  std::vector<std::uint16_t> start;  // codes before the first event
  ChangedSamples samples;
  std::int64_t end_ns = 0;
};

// A header of a few bytes may name a picture of gigabytes. Throws InputError if it has far more values than the file has
// events.
void check_picture_size(const Shape& shape, std::uint64_t events, const std::string& name);

// How many samples changes make, in the order of their times.
template <typename Changes, typename TimeOf>
[[nodiscard]] std::uint64_t count_samples(const ChangedSamples& samples, const Changes& changes,
                                          TimeOf time_ns) {
  std::uint64_t count = 1;
  std::int64_t last_ns = 0;
  for (const auto& change : changes) {
    const std::int64_t start_ns = samples.start_of(time_ns(change));
    if (start_ns > last_ns) ++count;
    last_ns = start_ns;
  }
  return count;
}

// What a recording takes while it is opened.
struct EventSizes {
  std::uint64_t event_bytes = 0;  // of each event, as it is read
  std::uint64_t events = 0;
  std::uint64_t samples = 0;  // the moments at which something changes
};
// Throws MemoryTooLittle if that is more than ClipOptions::decoder_bytes.
void check_event_memory(const EventSizes& sizes, const Shape& shape, const ClipOptions& options);

// `info` is given the codes' format, facts and notes. `name` is the recording's. Throws MemoryTooLittle.
[[nodiscard]] EventLight light_of_events(const CameraEvents& recording, const std::string& name,
                                         const ClipOptions& options, ClipInfo& info);

}  // namespace nutik
