#include "session/clips/evened_times.hpp"

#include <algorithm>
#include <span>

#include "capture/format.hpp"
#include "capture/median.hpp"
#include "session/text/number_text.hpp"

namespace nutik {

namespace {

// Players show a part of a clip slower: steps of two lengths, the longer a whole number of times the shorter, many of
// them one after another where dropped pictures leave single ones.
std::optional<Note> ramp_note(const std::vector<std::int64_t>& steps) {
  const std::int64_t least = *std::ranges::min_element(steps), most = *std::ranges::max_element(steps);
  if (least <= 0) return std::nullopt;
  const std::int64_t times = (most + least / 2) / least;
  const auto is_near = [](std::int64_t step, std::int64_t length) {
    return std::abs(step - length) <= length / 20 + 1;
  };
  std::ptrdiff_t slow = 0, changes = 0;
  double seconds = 0;  // that the quick ones last
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const bool is_slow = is_near(steps[k], most);
    if (!is_slow && !is_near(steps[k], least)) return std::nullopt;
    slow += is_slow ? 1 : 0;
    if (!is_slow) seconds += static_cast<double>(steps[k]) / kSecondNs;
    if (k > 0 && is_slow != is_near(steps[k - 1], most)) ++changes;
  }
  const auto quick = static_cast<std::ptrdiff_t>(steps.size()) - slow;
  constexpr std::ptrdiff_t kLeastInARow = 3;
  if (times < 2 || !is_near(most, times * least) || std::min(slow, quick) < kLeastInARow * (changes + 1) / 2)
    return std::nullopt;
  return Note(
      format("{} of the clip's {} steps from one picture to the next last {} and {} last {}, {} times as long, as in a "
             "film that was taken at one rate and plays slower in a part: if so, state the rate, {:.0f}",
             quick, steps.size(), duration_text(least), slow, duration_text(most), times,
             static_cast<double>(quick) / seconds),
      {Setting::frame_rate});
}

}  // namespace

std::optional<Note> evened_note(const std::vector<std::int64_t>& starts_ns) {
  if (starts_ns.size() < 3) return std::nullopt;
  std::vector<std::int64_t> steps;
  for (std::size_t k = 1; k < starts_ns.size(); ++k) steps.push_back(starts_ns[k] - starts_ns[k - 1]);
  const std::size_t count = steps.size();
  const std::int64_t usual = median(steps);
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
  if (auto ramp = ramp_note(steps)) return ramp;
  const std::int64_t usual = median(steps);
  const auto gaps =
      std::ranges::count_if(steps, [usual](std::int64_t step) { return step - usual >= usual / 2; });
  if (gaps == 0) return std::nullopt;
  return Note(format(
      "{} of the clip's {} steps from one picture to the next {} longer than the usual {}, up to {}, as "
      "where pictures are missing: a picture before such a step counts as exposed for {} of 360 degrees "
      "of all of it; its own exposure can be stated, in a table of stills (exposure_ns) or with an array",
      gaps, steps.size(), gaps == 1 ? "is" : "are", duration_text(usual),
      duration_text(*std::ranges::max_element(steps)), timeline.shutter_angle().text()));
}

}  // namespace nutik
