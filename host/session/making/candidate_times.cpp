#include "session/making/candidate_times.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "session/text/time_text.hpp"

namespace nutik {
namespace {

constexpr std::uint64_t kMaxCombinations = 1'000'000;
// Candidates where no step is stated: a picture's time apart, further where that is more than so many of all times
// together.
constexpr std::uint64_t kDefaultCombinations = 20'000;
// Which numbers a name may stand for, in nanoseconds.
struct FreeRange {
  std::int64_t from_ns = 0, to_ns = 0;
};

class Candidates {
 public:
  Candidates(const FunctionTemplate& functions, const std::vector<StatedFreedom>& free,
             const Timeline& timeline)
      : functions_(functions), free_(free), timeline_(timeline) {}

  [[nodiscard]] std::vector<CandidateTimes> all() const {
    std::vector<CandidateTimes> candidates;
    std::uint64_t combinations = 1;
    std::vector<std::size_t> unstepped;
    for (const std::string& name : functions_.times) {
      const TimeFreedom& free = freedom(name);
      const FreeRange range = range_of(free, name);
      CandidateTimes& each = candidates.emplace_back();
      if (free.step) {
        each.times_ns = stepped(free, range);
        if (each.times_ns.empty()) {
          throw UsageError(format("{} has no time from {} to {} in steps of {}", name, free.from.text(),
                                  free.to.text(), free.step->text()));
        }
        combinations = multiplied(combinations, each.times_ns.size());
      } else {
        unstepped.push_back(candidates.size() - 1);
        each.times_ns = {range.from_ns, range.to_ns};
      }
    }
    // Evenly many of each, a picture's time apart at the closest.
    const auto share = static_cast<double>(std::max<std::uint64_t>(kDefaultCombinations / combinations, 2));
    for (const std::size_t at : unstepped) {
      CandidateTimes& each = candidates[at];
      const std::int64_t from_ns = each.times_ns.front(), span_ns = each.times_ns.back() - from_ns;
      const auto most =
          static_cast<std::int64_t>(std::pow(share, 1.0 / static_cast<double>(unstepped.size())));
      const std::int64_t period_ns = std::max<std::int64_t>(
          timeline_.duration_ns() / static_cast<std::int64_t>(timeline_.sample_count()), 1);
      const std::int64_t steps =
          std::clamp<std::int64_t>(span_ns / period_ns, 1, std::max<std::int64_t>(most - 1, 1));
      each.times_ns.clear();
      for (std::int64_t i = 0; i <= steps; ++i)
        each.times_ns.push_back(from_ns +
                                static_cast<std::int64_t>(static_cast<int128>(span_ns) * i / steps));
      each.times_ns.erase(std::unique(each.times_ns.begin(), each.times_ns.end()), each.times_ns.end());
      each.step_ns = std::max<std::int64_t>(span_ns / steps, 1);
      combinations = multiplied(combinations, each.times_ns.size());
    }
    return candidates;
  }

 private:
  static std::uint64_t multiplied(std::uint64_t combinations, std::uint64_t by) {
    if (combinations * by > kMaxCombinations) {
      throw UsageError(
          format("there are more than {} combinations of times to try; take larger steps or narrower ranges",
                 kMaxCombinations));
    }
    return combinations * by;
  }

  [[nodiscard]] const TimeFreedom& freedom(const std::string& name) const {
    const auto found = std::ranges::find(free_, name, &StatedFreedom::name);
    if (found == free_.end()) {
      throw UsageError(format("{} stands for a time: state from when to when it is to be looked for", name));
    }
    return std::get<TimeFreedom>(found->range);
  }

  [[nodiscard]] FreeRange range_of(const TimeFreedom& free, const std::string& name) const {
    const FreeRange range{moment_ns(free.from, timeline_), moment_ns(free.to, timeline_)};
    if (range.from_ns > range.to_ns)
      throw UsageError(format("{}: {} is behind {}", name, free.from.text(), free.to.text()));
    if (range.from_ns < 0 || range.to_ns > timeline_.duration_ns()) {
      throw UsageError(format("{}: {} to {} does not lie in the capture, which lasts {}", name,
                              free.from.text(), free.to.text(), duration_text(timeline_.duration_ns())));
    }
    return range;
  }

  [[nodiscard]] std::vector<std::int64_t> stepped(const TimeFreedom& free, const FreeRange& range) const {
    std::vector<std::int64_t> times_ns;
    if (free.step->counts_samples()) {
      std::uint64_t sample = sample_at(range.from_ns, timeline_);
      if (timeline_.start_ns(sample) < range.from_ns) ++sample;
      for (; sample < timeline_.sample_count() && timeline_.start_ns(sample) <= range.to_ns;
           sample += static_cast<std::uint64_t>(free.step->number.numerator)) {
        times_ns.push_back(timeline_.start_ns(sample));
      }
      return times_ns;
    }
    const std::int64_t step_ns = std::max<std::int64_t>(free.step->nanoseconds(), 1);
    static_cast<void>(multiplied(1, static_cast<std::uint64_t>((range.to_ns - range.from_ns) / step_ns)));
    const ExactTime from = exact_time(free.from, "the range", timeline_),
                    step = free.step->nanoseconds() > 0 ? exact_time(*free.step, "the step", timeline_)
                                                        : ExactTime{1, 1};
    for (int128 k = 0;; ++k) {
      const std::int64_t time_ns = rounded_sum(from, {k * step.numerator, step.denominator});
      if (time_ns > range.to_ns) return times_ns;
      if (times_ns.empty() || time_ns > times_ns.back()) times_ns.push_back(time_ns);
    }
  }

  const FunctionTemplate& functions_;
  const std::vector<StatedFreedom>& free_;
  const Timeline& timeline_;
};

}  // namespace

std::vector<CandidateTimes> candidate_times(const FunctionTemplate& functions,
                                            const std::vector<StatedFreedom>& free,
                                            const Timeline& timeline) {
  return Candidates(functions, free, timeline).all();
}

}  // namespace nutik
