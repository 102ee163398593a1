#include "session/requests/sweep_request.hpp"

#include <algorithm>
#include <utility>

#include "capture/format.hpp"
#include "exposure/gain_function.hpp"
#include "session/text/time_text.hpp"

namespace nutik {
namespace {

int128 common_divisor(int128 a, int128 b) {
  while (b != 0) {
    const int128 rest = a % b;
    a = b;
    b = rest;
  }
  return a < 0 ? -a : a;
}

// So many periods of a clip: its mean ones where its times are irregular.
std::int64_t periods_ns(const Rational& count, const Timeline& timeline) {
  const Rational rate = timeline.rate();
  return timeline.is_constant()
             ? round_half_up(static_cast<int128>(count.numerator) * rate.denominator * kSecondNs,
                             static_cast<int128>(count.denominator) * rate.numerator)
             : round_half_up(
                   static_cast<int128>(count.numerator) * timeline.duration_ns(),
                   static_cast<int128>(count.denominator) * static_cast<int128>(timeline.sample_count()));
}

// from + number · step, exactly.
std::pair<int128, int128> exact_value(const SweepRange& range, std::uint64_t number) {
  const auto& [parameter, from, to, step, counts_pictures] = range;
  return {static_cast<int128>(from.numerator) * step.denominator +
              static_cast<int128>(number) * step.numerator * from.denominator,
          static_cast<int128>(from.denominator) * step.denominator};
}

// The functions with the value of a number applied.
FunctionSet with_value(const FunctionSet& functions, const SweepRange& range, std::uint64_t number,
                       const Timeline& timeline) {
  const auto each = [&](auto change) {
    FunctionSet changed;
    for (const auto& [tag, function] : functions) changed.emplace(tag, change(function));
    return changed;
  };
  if (range.parameter == SweepParameter::shift) {
    const std::int64_t by_ns =
        range.counts_pictures ? periods_ns(range.value(number), timeline) : range.shift_ns(number);
    return each([&](const GainFunction& function) { return function.shifted(by_ns); });
  }
  const Rational value = range.value(number);
  if (range.parameter == SweepParameter::gain) {
    return each([&](const GainFunction& function) { return function.scaled(value.value()); });
  }
  std::int64_t fixed_ns = timeline.duration_ns();
  for (const auto& [tag, function] : functions) {
    const GainSummary summary = summarize(function, timeline.duration_ns());
    if (summary.support_ns > 0) fixed_ns = std::min(fixed_ns, summary.live.begin_ns);
  }
  return each([&](const GainFunction& function) { return function.stretched(value, fixed_ns); });
}

}  // namespace

std::uint64_t SweepRange::count() const {
  // floor((to - from) / step) + 1
  const int128 numerator = (static_cast<int128>(to.numerator) * from.denominator -
                            static_cast<int128>(from.numerator) * to.denominator) *
                           step.denominator;
  const int128 denominator = static_cast<int128>(from.denominator) * to.denominator * step.numerator;
  return static_cast<std::uint64_t>(numerator / denominator) + 1;
}

Rational SweepRange::value(std::uint64_t number) const {
  const auto [numerator, denominator] = exact_value(*this, number);
  const int128 divisor = common_divisor(numerator, denominator);
  return Rational::of(static_cast<std::int64_t>(numerator / divisor),
                      static_cast<std::int64_t>(denominator / divisor));
}

std::int64_t SweepRange::shift_ns(std::uint64_t number) const {
  const auto [numerator, denominator] = exact_value(*this, number);
  return round_half_up(numerator, denominator);
}

std::string SweepRange::label(std::uint64_t number) const {
  if (parameter == SweepParameter::gain) return format("gain × {}", value(number).text());
  if (parameter == SweepParameter::stretch) return format("length × {}", value(number).text());
  const Rational at = counts_pictures ? value(number) : Rational{shift_ns(number), 1};
  if (at.numerator == 0) return "as it is";
  const char* sign = at.numerator < 0 ? "−" : "+";
  const Rational distance{at.numerator < 0 ? -at.numerator : at.numerator, at.denominator};
  if (counts_pictures) return format("{}{} f", sign, distance.text());
  return format("{}{}", sign, duration_text(distance.numerator));
}

std::vector<SweepPoint> SweepRequest::points() const {
  std::uint64_t count = 1;
  for (const SweepRange& range : ranges) count *= range.count();
  std::vector<SweepPoint> points(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    std::uint64_t rest = i;
    for (const SweepRange& range : ranges) {
      points[i].push_back(rest % range.count());
      rest /= range.count();
    }
  }
  return points;
}

std::string SweepRequest::label(const SweepPoint& point) const {
  std::string label;
  for (std::size_t i = 0; i < ranges.size(); ++i) label += (i == 0 ? "" : ", ") + ranges[i].label(point[i]);
  return label;
}

FunctionSet SweepRequest::varied(FunctionSet functions, const SweepPoint& point,
                                 const Timeline& timeline) const {
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    functions = with_value(functions, ranges[i], point[i], timeline);
  }
  return functions;
}

}  // namespace nutik
