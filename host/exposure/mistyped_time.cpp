#include "exposure/mistyped_time.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>
#include <tuple>

namespace nutik {
namespace {

std::size_t digit_count(std::int64_t magnitude) {
  std::size_t count = 1;
  for (; magnitude >= 10; magnitude /= 10) ++count;
  return count;
}

// A time that one digit makes out of another.
struct Candidate {
  std::int64_t time_ns;
  bool is_digit_lost;  // the digit was added again
  bool is_in_run;      // beside another one like it
};

// Calls visit(candidate) for every time that differs from `time_ns` by one digit more or less.
template <typename Visit>
void for_each_candidate(std::int64_t time_ns, Visit visit) {
  const std::string digits = std::to_string(std::abs(time_ns));
  const auto offer = [&](const std::string& text, bool is_digit_lost, bool is_in_run) {
    std::int64_t magnitude = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), magnitude);
    if (error != std::errc() || magnitude > kLargestTimeNs) return;
    visit(Candidate{time_ns < 0 ? -magnitude : magnitude, is_digit_lost, is_in_run});
  };
  for (std::size_t at = 0; at <= digits.size(); ++at) {
    for (char digit = '0'; digit <= '9'; ++digit) {
      const bool is_in_run =
          (at > 0 && digits[at - 1] == digit) || (at < digits.size() && digits[at] == digit);
      offer(std::string(digits).insert(at, 1, digit), true, is_in_run);
    }
  }
  for (std::size_t at = 0; at < digits.size() && digits.size() > 1; ++at) {
    const bool is_in_run =
        (at > 0 && digits[at - 1] == digits[at]) || (at + 1 < digits.size() && digits[at + 1] == digits[at]);
    offer(std::string(digits).erase(at, 1), false, is_in_run);
  }
}

// Whether a number with a digit more or less than `time_ns` can lie in the window: nearly no ramp gets further.
bool may_reach(std::int64_t time_ns, std::int64_t low_ns, std::int64_t high_ns) {
  const std::size_t count = digit_count(std::abs(time_ns));
  const std::size_t low = digit_count(std::abs(low_ns));
  const std::size_t high = digit_count(std::abs(high_ns));
  const auto [least, most] = std::minmax(low, high);
  // A window round 0 has small numbers of every length.
  return (low_ns <= 0 && high_ns >= 0) || (count + 1 >= least && count <= most + 1);
}

}  // namespace

std::vector<MistypedTime> mistyped_times(const GainFunction& function) {
  constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
  const auto points = function.points();
  std::vector<MistypedTime> found;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const std::int64_t begin_ns = points[i].time_ns;
    const std::int64_t end_ns = points[i + 1].time_ns;
    if (points[i].gain == points[i + 1].gain || end_ns - begin_ns <= kLongestStepNs) continue;
    std::optional<MistypedTime> best;
    const auto rank = [](const MistypedTime& time, bool is_in_run) {
      return std::tuple(!time.is_digit_lost, !is_in_run, time.step_ns);
    };
    bool best_is_in_run = false;
    // `other_ns` is the ramp's other end; the new time must lie in [low_ns, high_ns].
    const auto try_end = [&](std::size_t point, std::int64_t other_ns, std::int64_t low_ns,
                             std::int64_t high_ns) {
      if (low_ns > high_ns || !may_reach(points[point].time_ns, low_ns, high_ns)) return;
      for_each_candidate(points[point].time_ns, [&](const Candidate& candidate) {
        if (candidate.time_ns < low_ns || candidate.time_ns > high_ns) return;
        const MistypedTime time{point, i, candidate.time_ns, std::abs(other_ns - candidate.time_ns),
                                candidate.is_digit_lost};
        if (best && rank(*best, best_is_in_run) <= rank(time, candidate.is_in_run)) return;
        best = time;
        best_is_in_run = candidate.is_in_run;
      });
    };
    const std::int64_t before_ns = i > 0 ? points[i - 1].time_ns : -kNever;
    const std::int64_t after_ns = i + 2 < points.size() ? points[i + 2].time_ns : kNever;
    try_end(i, end_ns, std::max(before_ns + 1, end_ns - kLongestStepNs), end_ns - 1);
    try_end(i + 1, begin_ns, begin_ns + 1, std::min(after_ns - 1, begin_ns + kLongestStepNs));
    if (best) found.push_back(*best);
  }
  return found;
}

}  // namespace nutik
