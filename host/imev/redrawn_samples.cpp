#include "imev/redrawn_samples.hpp"

#include <algorithm>

namespace nutik {

std::vector<std::uint64_t> redrawn_samples(const Activity& activity) {
  const std::vector<std::uint64_t>& changed = activity.any_changed_pixels();
  const std::vector<std::uint64_t>& much = activity.much_changed_pixels();
  const std::uint64_t pixels = activity.changes().size();
  std::vector<std::uint64_t> redrawn;
  for (std::uint64_t k = 1; k < changed.size(); ++k) {
    // The first sample cannot change.
    const std::uint64_t before = k > 1 ? changed[k - 1] : 0;
    const std::uint64_t after = k + 1 < changed.size() ? changed[k + 1] : 0;
    const bool has_beside = k > 1 || k + 1 < changed.size();
    if (has_beside && 4 * changed[k] >= pixels && 2 * changed[k] >= 3 * std::max(before, after) &&
        4 * much[k] < changed[k])
      redrawn.push_back(k);
  }
  return redrawn;
}

}  // namespace nutik
