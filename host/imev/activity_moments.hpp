// Where a capture is busy and where it is quiet: the moments to look at first.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "capture/timeline.hpp"

namespace nutik {

// A run of samples, and how many changes of pixels it has.
struct ActivityStretch {
  SampleRange samples;
  std::uint64_t changes = 0;

  // Of so many pixels, those that change at a sample, on average.
  [[nodiscard]] double mean_share(std::uint64_t pixels) const {
    return static_cast<double>(changes) / static_cast<double>(pixels) / static_cast<double>(samples.size());
  }
};

struct ActivityMoments {
  std::uint64_t busiest_sample = 0;  // at which most pixels change; the first of several
  ActivityStretch busiest;
  ActivityStretch quietest;
};

// Stretches are a twentieth of the capture long, one sample at least; of several alike the first is taken. The
// first sample, which can have no change, lies in none. Empty where there are fewer than three samples or
// nothing ever changes. `changed_pixels` has the number of pixels for each sample.
[[nodiscard]] std::optional<ActivityMoments> activity_moments(std::span<const std::uint64_t> changed_pixels);

}  // namespace nutik
