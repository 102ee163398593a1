#include "capture/made_samples.hpp"

#include <algorithm>
#include <numeric>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"

namespace nutik {

std::uint64_t MadeSamples::count() const {
  return std::accumulate(after.begin(), after.end(), std::uint64_t{0});
}

std::vector<bool> MadeSamples::marks() const {
  std::vector<bool> marks;
  for (const std::uint8_t made : after) {
    marks.push_back(false);
    marks.insert(marks.end(), made, true);
  }
  return marks;
}

Timeline MadeSamples::times(const Timeline& filmed) const {
  if (count() == 0) return filmed;
  std::vector<Exposure> exposures;
  exposures.reserve(total());
  std::int64_t begin = filmed.start_ns(0);  // of the next filmed sample, as far as the one before leaves it
  for (std::uint64_t k = 0; k < after.size(); ++k) {
    const std::int64_t start = filmed.start_ns(k), end = filmed.end_ns(k);
    const int128 steps = after[k] + 1;
    if (steps == 1) {
      exposures.push_back({begin, end});
      if (k + 1 < after.size()) begin = filmed.start_ns(k + 1);
      continue;
    }
    // Middles of exposures lie evenly between those of the filmed ones; in halves of a nanosecond.
    const std::int64_t next_start = filmed.start_ns(k + 1), next_end = filmed.end_ns(k + 1);
    const int128 middle = int128{start} + end, way = int128{next_start} + next_end - middle;
    const int128 length = std::min(end - start, next_end - next_start);
    const auto border = [&](int128 step) {  // halfway from that middle to the next
      return round_half_up(2 * steps * middle + (2 * step + 1) * way, 4 * steps);
    };
    exposures.push_back({begin, std::min(end, border(0))});
    for (int128 step = 1; step < steps; ++step) {
      const int128 twice = steps * middle + step * way;
      exposures.push_back({std::max(border(step - 1), round_half_up(twice - steps * length, 2 * steps)),
                           std::min(border(step), round_half_up(twice + steps * length, 2 * steps))});
    }
    begin = std::max(next_start, border(steps - 1));
  }
  return Timeline::stored(std::move(exposures), filmed.duration_ns(), filmed.shutter_angle()).with_pictures(filmed);
}

bool MadeSamples::cut_to(std::uint64_t samples) {
  std::uint64_t before = 0;
  for (std::size_t picture = 0; picture < after.size() && before < samples; ++picture) {
    const std::uint64_t end = before + 1 + after[picture];
    if (end >= samples) {
      after.resize(picture + 1);
      after.back() = static_cast<std::uint8_t>(samples - before - 1);
    }
    before = end;
  }
  return before >= samples;
}

double MadeSamples::unfollowed_percent() const {
  return changed == 0 ? 0 : 100.0 * static_cast<double>(unfollowed) / static_cast<double>(changed);
}

std::string MadeSamples::text() const {
  return format("{} samples made along the motion between {} filmed; {:.1f} % of what changes could not be followed",
                count(), after.size(), unfollowed_percent());
}

std::string MadeSamples::kept_text() const {
  std::string text = format("{} {}", changed, unfollowed);
  for (auto run = after.begin(); run != after.end();) {
    const auto end = std::find_if(run, after.end(), [&](std::uint8_t made) { return made != *run; });
    text += format(" {}*{}", *run, end - run);
    run = end;
  }
  return text;
}

MadeSamples MadeSamples::parse(std::string_view text) {
  MadeSamples made;
  const auto take = [&](char behind) {
    std::uint64_t number = 0;
    const bool is_number = take_number(text, number), goes_on = text.starts_with(behind);
    if (!is_number || number > kMostFilmed || !(goes_on || (behind == ' ' && text.empty())))
      throw UsageError("what it says of its made samples is damaged");
    if (goes_on) text.remove_prefix(1);
    return number;
  };
  made.changed = take(' ');
  made.unfollowed = take(' ');
  while (!text.empty()) {
    const std::uint64_t each = take('*'), run = take(' ');
    if (each > kMost || made.after.size() + run > kMostFilmed)
      throw UsageError("what it says of its made samples is damaged");
    made.after.insert(made.after.end(), run, static_cast<std::uint8_t>(each));
  }
  if (made.after.empty())
    throw UsageError("what it says of its made samples is damaged");
  return made;
}

}  // namespace nutik
