// Light from the events of a contrast-detecting camera.
//
// Each event is a step of the logarithm of light at its pixel, up or down, from a light at the start:
//
//     light(t) = start · exp(up · n_up(t) − down · n_down(t))
//
// The logarithm is kept as it is; only the code that stands for light ends at white, so light that was above white
// comes back as it went. A code is that whose light is next: 16 bits, linear unless another transfer function is
// stated.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "capture/pixel_change.hpp"
#include "capture/timeline.hpp"
#include "media/clip.hpp"
#include "media/events/prophesee_events.hpp"

namespace nutik {

// The samples of a recording without pictures, as what changes with each.
//
//   in:      changes of pixels in the order of their times
//   out:     a sample for each moment, or tick, in which something changes
//   always:  the first sample begins at 0
class ChangedSamples {
 public:
  // Changes count at the start of the tick that they are in; ticks begin at 0.
  explicit ChangedSamples(std::int64_t tick_ns) : tick_ns_(tick_ns) { begin(0); }

  // `time_ns` is not before that of the change before.
  void add(std::int64_t time_ns, const PixelChange& change) {
    const std::int64_t start_ns = start_of(time_ns);
    if (start_ns > starts_ns_.back()) begin(start_ns);
    changes_.push_back(change);
  }

  // When the tick begins that a time is in.
  [[nodiscard]] std::int64_t start_of(std::int64_t time_ns) const { return time_ns / tick_ns_ * tick_ns_; }
  // Room for no more than so many changes in so many samples.
  void reserve(std::uint64_t changes, std::uint64_t samples) {
    changes_.reserve(changes);
    starts_ns_.reserve(samples);
    firsts_.reserve(samples);
  }

  [[nodiscard]] std::uint64_t count() const { return starts_ns_.size(); }
  // What changes with a sample; with the first one, from what was before it.
  [[nodiscard]] std::span<const PixelChange> of(std::uint64_t sample) const {
    const std::size_t end = sample + 1 < firsts_.size() ? firsts_[sample + 1] : changes_.size();
    return std::span(changes_).subspan(firsts_[sample], end - firsts_[sample]);
  }

  // Each sample is exposed until the next, the last until `end_ns`, and for a nanosecond at least.
  [[nodiscard]] std::vector<Exposure> exposures(std::int64_t end_ns) const {
    std::vector<Exposure> exposures;
    exposures.reserve(starts_ns_.size());
    for (std::size_t k = 0; k < starts_ns_.size(); ++k) {
      const bool is_last = k + 1 == starts_ns_.size();
      exposures.push_back({starts_ns_[k], is_last ? std::max(end_ns, starts_ns_[k] + 1) : starts_ns_[k + 1]});
    }
    return exposures;
  }

  // What so many changes in so many samples take, with the times that a clip tells of these and two timelines made of
  // them.
  [[nodiscard]] static std::uint64_t bytes_of(std::uint64_t changes, std::uint64_t samples) {
    return changes * sizeof(PixelChange) +
           samples * (sizeof(std::int64_t) + sizeof(std::uint64_t) + 3 * sizeof(Exposure));
  }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_of(changes_.capacity(), starts_ns_.capacity()); }

 private:
  void begin(std::int64_t start_ns) {
    starts_ns_.push_back(start_ns);
    firsts_.push_back(changes_.size());
  }

  std::int64_t tick_ns_;
  std::vector<std::int64_t> starts_ns_;
  std::vector<std::uint64_t> firsts_;  // of each sample, among the changes
  std::vector<PixelChange> changes_;
};

struct EventLight {
  std::vector<std::uint16_t> start;  // codes before the first event
  ChangedSamples samples;
  std::int64_t end_ns = 0;
};

// A header of a few bytes may name a picture of gigabytes. Throws InputError if it has far more values than the file
// has events.
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

// Reads a raw ADΔER file (adder_events.cpp). `info` is given the codes' format, facts and notes. Throws InputError if
// the file is no such file or holds no event, UsageError if what is stated cannot be said of it.
[[nodiscard]] EventLight read_adder_file(std::span<const std::byte> file, const std::string& name,
                                         const ClipOptions& options, ClipInfo& info);

}  // namespace nutik
