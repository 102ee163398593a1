#include "imev/activity_moments.hpp"

#include <algorithm>
#include <numeric>

namespace nutik {
namespace {

constexpr std::uint64_t kStretchesInACapture = 20;

}  // namespace

std::optional<ActivityMoments> activity_moments(std::span<const std::uint64_t> changed_pixels) {
  const std::uint64_t count = changed_pixels.size();
  if (count < 3) return std::nullopt;
  const auto busiest = std::max_element(changed_pixels.begin() + 1, changed_pixels.end());
  if (*busiest == 0) return std::nullopt;
  const std::uint64_t length = std::max<std::uint64_t>(1, count / kStretchesInACapture);
  const auto front = changed_pixels.subspan(1, length);
  ActivityStretch stretch{{1, 1 + length}, std::accumulate(front.begin(), front.end(), std::uint64_t{0})};
  ActivityMoments moments{static_cast<std::uint64_t>(busiest - changed_pixels.begin()), stretch, stretch};
  while (stretch.samples.last < count) {
    stretch.changes += changed_pixels[stretch.samples.last++];
    stretch.changes -= changed_pixels[stretch.samples.first++];
    if (stretch.changes > moments.busiest.changes) moments.busiest = stretch;
    if (stretch.changes < moments.quietest.changes) moments.quietest = stretch;
  }
  return moments;
}

}  // namespace nutik
