#include "session/clips/evened_times.hpp"

#include <algorithm>
#include <span>

#include "capture/format.hpp"
#include "session/text/time_text.hpp"

namespace nutik {

namespace {

// The middle one of the steps, which are put into another order.
std::int64_t default_step(std::vector<std::int64_t>& steps) {
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  return *middle;
}

}  // namespace

std::optional<Note> evened_note(const std::vector<std::int64_t>& starts_ns) {
  if (starts_ns.size() < 3) return std::nullopt;
  std::vector<std::int64_t> steps;
  for (std::size_t k = 1; k < starts_ns.size(); ++k) steps.push_back(starts_ns[k] - starts_ns[k - 1]);
  const std::size_t count = steps.size();
  const std::int64_t usual = default_step(steps);
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

std::optional<Note> gap_note(const Timeline& timeline) {
  const std::span<const Exposure> exposures = timeline.table();
  if (exposures.size() < 3) return std::nullopt;
  std::vector<std::int64_t> steps;
  for (std::size_t k = 1; k < exposures.size(); ++k)
    steps.push_back(exposures[k].start_ns - exposures[k - 1].start_ns);
  const std::int64_t usual = default_step(steps);
  const auto gaps =
      std::ranges::count_if(steps, [usual](std::int64_t step) { return step - usual >= usual / 2; });
  if (gaps == 0) return std::nullopt;
  return Note(format(
      "{} of the clip's {} steps from one picture to the next {} longer than the usual {}, up to {}, as "
      "where pictures are missing: a picture before such a step counts as exposed for {} of 360 degrees "
      "of all of it; a table of stills can list how long it really was (exposure_ns)",
      gaps, steps.size(), gaps == 1 ? "is" : "are", duration_text(usual),
      duration_text(*std::ranges::max_element(steps)), timeline.shutter_angle().text()));
}

}  // namespace nutik
