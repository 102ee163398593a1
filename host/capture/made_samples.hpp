// Samples that nobody filmed: made between two that were filmed, along the motion from one to the other.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "capture/timeline.hpp"

namespace nutik {

struct MadeSamples {
  static constexpr std::uint32_t kMost = 63;  // between two filmed ones
  static constexpr std::uint64_t kMostFilmed = std::uint64_t{1} << 24;  // six days at 30 a second

  std::vector<std::uint8_t> after;  // how many were made after each filmed sample
  // Blocks of pixels that changed from one filmed sample to the next, counted over the capture, and those whose motion
  // was not found: there light goes from one value to the other in a straight line.
  std::uint64_t changed = 0, unfollowed = 0;

  [[nodiscard]] std::uint64_t count() const;                    // of those made
  [[nodiscard]] std::uint64_t total() const { return after.size() + count(); }
  [[nodiscard]] std::vector<bool> marks() const;  // of each sample, whether it was made
  // The times of all samples, where those that were filmed have these. A made one is exposed as long as its neighbours,
  // and no exposure reaches further than halfway to the middle of the next.
  [[nodiscard]] Timeline times(const Timeline& filmed) const;

  // Leaves out what a capture that ends after so many samples does not have. False where it has more.
  [[nodiscard]] bool cut_to(std::uint64_t samples);

  [[nodiscard]] double unfollowed_percent() const;
  // `31 made between 12 filmed, 4.2 % of what moves could not be followed`
  [[nodiscard]] std::string text() const;
  // For a file: `1200 52 3*28 0*4`, in runs; parse() throws UsageError where that is damaged.
  [[nodiscard]] std::string kept_text() const;
  [[nodiscard]] static MadeSamples parse(std::string_view text);

  friend bool operator==(const MadeSamples&, const MadeSamples&) = default;
};

}  // namespace nutik
