#include "session/requests/sweep_request.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/gain_function.hpp"
#include "session/requests/stated_time.hpp"
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

struct RangeText {
  std::string from, to, step;
};

RangeText split(SweepParameter parameter, const std::string& text, std::string_view what) {
  const auto dots = text.find("..");
  // The last slash: times may be written as fractions, 1/50s.
  const auto slash = text.rfind('/');
  if (dots == std::string::npos || slash == std::string::npos || slash < dots + 3) {
    throw UsageError(format("{} '{}' is no range; write FROM..TO/STEP: {}", what, text,
                            parameter == SweepParameter::shift ? "0..1s/0.1s" : "0.5..2/0.25"));
  }
  return {text.substr(0, dots), text.substr(dots + 2, slash - dots - 2), text.substr(slash + 1)};
}

// So that sums of them and products with times fit 128 bits.
void require_modest(const std::string& text, std::string_view what,
                    std::initializer_list<Rational> numbers) {
  for (const Rational& number : numbers) {
    if (std::abs(number.numerator) <= 1'000'000'000 && number.denominator <= 1'000'000) continue;
    throw UsageError(format("{} '{}': {} has too many digits; write up to nine, six of them after the point",
                            what, text, number.text()));
  }
}

// Times in one unit: nanoseconds, or pictures of the clip. A bare 0 is of any.
SweepRange shift_range(const std::string& text, std::string_view what) {
  const RangeText parts = split(SweepParameter::shift, text, what);
  SweepRange range;
  const StatedTime step = StatedTime::parse(parts.step, std::string(what) + "'s step");
  const auto parse = [&](const std::string& part) {
    if (part == "0") return Rational{0, 1};
    const StatedTime time = StatedTime::parse(part, what);
    if (time.counts_samples() != step.counts_samples())
      throw UsageError(format("{} '{}' mixes times and pictures; use one of them", what, text));
    return time.counts_samples() ? time.number : time.modest_nanoseconds();
  };
  range.counts_pictures = step.counts_samples();
  range.step = step.counts_samples() ? step.number : step.modest_nanoseconds();
  range.from = parse(parts.from);
  range.to = parse(parts.to);
  if (!range.counts_pictures) return range;
  require_modest(text, what, {range.from, range.to, range.step});
  for (const Rational& pictures : {range.from, range.to, range.step}) {
    if (pictures.denominator == 1) continue;
    throw UsageError(format("{} '{}': {}f is not a whole number of pictures", what, text, pictures.text()));
  }
  return range;
}

SweepRange factor_range(SweepParameter parameter, const std::string& text, std::string_view what) {
  const RangeText parts = split(parameter, text, what);
  SweepRange range;
  range.parameter = parameter;
  range.from = Rational::parse(parts.from, what);
  range.to = Rational::parse(parts.to, what);
  range.step = Rational::parse(parts.step, what);
  require_modest(text, what, {range.from, range.to, range.step});
  if (parameter == SweepParameter::stretch && range.from.numerator <= 0) {
    throw UsageError(format("{} '{}': a function cannot be made {} times as long; begin above 0", what, text,
                            range.from.text()));
  }
  return range;
}

}  // namespace

SweepRange SweepRange::parse(SweepParameter parameter, const std::string& text, std::string_view what) {
  const SweepRange range =
      parameter == SweepParameter::shift ? shift_range(text, what) : factor_range(parameter, text, what);
  const bool is_backwards = static_cast<int128>(range.to.numerator) * range.from.denominator <
                            static_cast<int128>(range.from.numerator) * range.to.denominator;
  if (range.step.numerator <= 0 || is_backwards)
    throw UsageError(format("{} '{}' is empty; FROM must not be above TO, STEP must be above 0", what, text));
  return range;
}

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
