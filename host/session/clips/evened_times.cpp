#include "session/clips/evened_times.hpp"

#include <algorithm>

#include "capture/format.hpp"
#include "session/text/time_text.hpp"

namespace nutik {

std::optional<Note> evened_note(const std::vector<std::int64_t>& starts_ns) {
  if (starts_ns.size() < 3) return std::nullopt;
  std::vector<std::int64_t> steps;
  for (std::size_t k = 1; k < starts_ns.size(); ++k) steps.push_back(starts_ns[k] - starts_ns[k - 1]);
  const std::size_t count = steps.size();
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::ranges::nth_element(steps, middle);
  const std::int64_t usual = *middle;
  // Less may be what a container's clock rounds.
  std::erase_if(steps,
                [usual](std::int64_t step) { return std::max(step - usual, usual - step) <= usual / 10; });
  const std::vector settings{Setting::frame_rate};
  if (steps.empty()) {
    return Note(format("the clip's steps from one picture to the next are about {} and differ by less than a "
                       "tenth: at the stated rate all last alike",
                       duration_text(usual)),
                settings);
  }
  const auto [least, most] = std::ranges::minmax(steps);
  return Note(
      format("{} of the clip's {} steps from one picture to the next {} {}{}, and the others about {}: "
             "at the stated rate all last alike",
             steps.size(), count, steps.size() == 1 ? "lasts" : "last", duration_text(least),
             least == most ? std::string() : " to " + duration_text(most), duration_text(usual)),
      settings);
}

}  // namespace nutik
