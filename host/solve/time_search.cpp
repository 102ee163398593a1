#include "solve/time_search.hpp"

#include <algorithm>
#include <exception>
#include <optional>
#include <tuple>
#include <utility>

#include "capture/error.hpp"
#include "system/interruption.hpp"

namespace nutik {
namespace {

// So many of the best candidates are followed between candidates.
constexpr std::size_t kFollowed = 6;

struct Tried {
  std::vector<std::int64_t> times_ns;
  double cost = 0.0;
};

class Follower {
 public:
  Follower(GainSearch& search, const std::vector<CandidateTimes>& candidates, std::uint64_t& tried)
      : search_(search), candidates_(candidates), tried_(tried) {}

  // From a place on along all times, by ever smaller steps, after Hooke and Jeeves (1961).
  [[nodiscard]] Tried from(Tried best) {
    std::int64_t step_ns = 0;
    for (const CandidateTimes& each : candidates_) step_ns = std::max(step_ns, each.step_ns);
    for (step_ns /= 2; step_ns > 0; step_ns /= 2) {
      for (;;) {
        const Tried around = explored(best, step_ns);
        if (around.cost >= best.cost) break;
        // On in the same direction, as long as that helps.
        Tried base = std::exchange(best, around);
        for (;;) {
          std::vector<std::int64_t> beyond = best.times_ns;
          for (std::size_t i = 0; i < beyond.size(); ++i) beyond[i] += best.times_ns[i] - base.times_ns[i];
          const auto next = at(std::move(beyond));
          if (!next) break;
          const Tried better = explored(*next, step_ns);
          if (better.cost >= best.cost) break;
          base = std::exchange(best, better);
        }
      }
    }
    return best;
  }

 private:
  [[nodiscard]] std::optional<Tried> at(std::vector<std::int64_t> times_ns) {
    check_interruption();
    for (std::size_t i = 0; i < times_ns.size(); ++i) {
      if (times_ns[i] < candidates_[i].times_ns.front() || times_ns[i] > candidates_[i].times_ns.back())
        return std::nullopt;
    }
    try {
      const auto found = search_.find(times_ns);
      if (!found) return std::nullopt;
      ++tried_;
      return Tried{std::move(times_ns), found->cost};
    } catch (const InputError&) {  // a function that cannot be normalized there
      return std::nullopt;
    }
  }

  // The best of one time after another changed by a step.
  [[nodiscard]] Tried explored(Tried best, std::int64_t step_ns) {
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      if (candidates_[i].step_ns == 0) continue;
      const Tried base = best;
      for (const std::int64_t by : {step_ns, -step_ns}) {
        std::vector<std::int64_t> moved = base.times_ns;
        moved[i] += by;
        if (const auto next = at(std::move(moved)); next && next->cost < best.cost) best = *next;
      }
    }
    return best;
  }

  GainSearch& search_;
  const std::vector<CandidateTimes>& candidates_;
  std::uint64_t& tried_;
};

}  // namespace

std::optional<FoundTimes> find_times(GainSearch& search, const std::vector<CandidateTimes>& candidates,
                                     const ReportedProgress& progress) {
  std::uint64_t combinations = 1, tried = 0;
  for (const CandidateTimes& each : candidates) combinations *= each.times_ns.size();
  std::vector<Tried> best;  // the cheapest first
  std::exception_ptr unusable;
  for (std::uint64_t number = 0; number < combinations; ++number) {
    check_interruption();
    if (progress) progress(number, combinations);
    std::vector<std::int64_t> times_ns(candidates.size());
    std::uint64_t rest = number;
    for (std::size_t i = candidates.size(); i-- > 0;) {  // the last time runs fastest
      times_ns[i] = candidates[i].times_ns[rest % candidates[i].times_ns.size()];
      rest /= candidates[i].times_ns.size();
    }
    std::optional<FoundGains> found;
    try {
      found = search.find(times_ns);
    } catch (const InputError&) {  // a function that cannot be normalized with these times
      unusable = std::current_exception();
    }
    if (!found) continue;
    ++tried;
    const auto behind = std::ranges::upper_bound(best, found->cost, {}, &Tried::cost);
    best.insert(behind, {std::move(times_ns), found->cost});
    if (best.size() > kFollowed) best.pop_back();
  }
  if (best.empty() && unusable) std::rethrow_exception(unusable);
  if (best.empty()) return std::nullopt;
  Follower follower(search, candidates, tried);
  for (Tried& each : best) each = follower.from(std::move(each));
  FoundTimes result;
  const auto by_cost_and_time = [](const Tried& each) { return std::tie(each.cost, each.times_ns); };
  result.times_ns = std::ranges::min_element(best, {}, by_cost_and_time)->times_ns;
  result.found = *search.find(result.times_ns);
  result.tried = tried;
  return result;
}

}  // namespace nutik
