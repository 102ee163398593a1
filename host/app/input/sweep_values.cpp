#include "app/input/sweep_values.hpp"

#include <algorithm>
#include <cstdlib>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/gain_function.hpp"

namespace nutik::app {
namespace {

std::string_view option_of(SweepParameter parameter) {
  switch (parameter) {
    case SweepParameter::shift: return "--shift";
    case SweepParameter::gain: return "--scale-gain";
    case SweepParameter::stretch: return "--stretch";
  }
  return {};
}

struct RangeText {
  std::string from, to, step;
};

RangeText split(SweepParameter parameter, const std::string& text) {
  const auto dots = text.find("..");
  // The last slash: times may be written as fractions, 1/50s.
  const auto slash = text.rfind('/');
  if (dots == std::string::npos || slash == std::string::npos || slash < dots + 3) {
    throw UsageError(format("{} '{}' is no range; write FROM..TO/STEP: {}", option_of(parameter), text,
                            parameter == SweepParameter::shift ? "0..1s/0.1s" : "0.5..2/0.25"));
  }
  return {text.substr(0, dots), text.substr(dots + 2, slash - dots - 2), text.substr(slash + 1)};
}

// So that sums of them and products with times fit 128 bits.
void require_modest(const std::string& text, std::string_view option,
                    std::initializer_list<Rational> numbers) {
  for (const Rational& number : numbers) {
    if (std::abs(number.numerator) <= 1'000'000'000 && number.denominator <= 1'000'000) continue;
    throw UsageError(format("{} '{}': {} has too many digits; write up to nine, six of them after the point",
                            option, text, number.text()));
  }
}

// Times in one unit: nanoseconds, or pictures of the clip. A bare 0 is of any.
SweepRange shift_range(const std::string& text) {
  const RangeText parts = split(SweepParameter::shift, text);
  SweepRange range;
  const TimeText step = TimeText::parse(parts.step, "--shift's step");
  const auto parse = [&](const std::string& part) {
    if (part == "0") return Rational{0, 1};
    const TimeText time = TimeText::parse(part, "--shift");
    if (time.counts_samples() != step.counts_samples()) {
      throw UsageError(format("--shift '{}' mixes times and pictures; use one of them", text));
    }
    return time.counts_samples() ? time.number : Rational{time.nanoseconds(), 1};
  };
  range.unit_ns = step.counts_samples() ? 0 : 1;
  range.step = step.counts_samples() ? step.number : Rational{step.nanoseconds(), 1};
  range.from = parse(parts.from);
  range.to = parse(parts.to);
  if (range.unit_ns != 0) return range;
  require_modest(text, "--shift", {range.from, range.to, range.step});
  for (const Rational& pictures : {range.from, range.to, range.step}) {
    if (pictures.denominator == 1) continue;
    throw UsageError(format("--shift '{}': {}f is not a whole number of pictures", text, pictures.text()));
  }
  return range;
}

SweepRange factor_range(SweepParameter parameter, const std::string& text) {
  const RangeText parts = split(parameter, text);
  SweepRange range;
  range.parameter = parameter;
  range.from = Rational::parse(parts.from, option_of(parameter));
  range.to = Rational::parse(parts.to, option_of(parameter));
  range.step = Rational::parse(parts.step, option_of(parameter));
  require_modest(text, option_of(parameter), {range.from, range.to, range.step});
  if (parameter == SweepParameter::stretch && range.from.numerator <= 0) {
    throw UsageError(format("--stretch '{}': a function cannot be made {} times as long; begin above 0", text,
                            range.from.text()));
  }
  return range;
}

// from + number · step, not reduced.
struct WideFraction {
  int128 numerator;
  int128 denominator;
};
WideFraction sum_of(const SweepRange& range, std::uint64_t number) {
  return {static_cast<int128>(range.from.numerator) * range.step.denominator +
              static_cast<int128>(number) * range.step.numerator * range.from.denominator,
          static_cast<int128>(range.from.denominator) * range.step.denominator};
}

int128 common_divisor(int128 a, int128 b) {
  while (b != 0) {
    const int128 rest = a % b;
    a = b;
    b = rest;
  }
  return a < 0 ? -a : a;
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
  const WideFraction sum = sum_of(*this, number);
  const int128 divisor = common_divisor(sum.numerator, sum.denominator);
  return Rational::of(static_cast<std::int64_t>(sum.numerator / divisor),
                      static_cast<std::int64_t>(sum.denominator / divisor));
}

std::string SweepRange::label(std::uint64_t number) const {
  const Rational at = value(number);
  switch (parameter) {
    case SweepParameter::gain: return format("gain × {}", at.text());
    case SweepParameter::stretch: return format("length × {}", at.text());
    case SweepParameter::shift: break;
  }
  if (at.numerator == 0) return "as it is";
  const char* sign = at.numerator < 0 ? "−" : "+";
  const Rational distance{at.numerator < 0 ? -at.numerator : at.numerator, at.denominator};
  if (unit_ns == 0) return format("{}{} f", sign, distance.text());
  return format("{}{}", sign, duration_text(distance.numerator));
}

std::vector<SweepRange> sweep_ranges(const Options& options) {
  std::vector<SweepRange> ranges;
  for (const Said& said : options.said) {
    if (said.option == "shift") {
      ranges.push_back(shift_range(said.words.front()));
    } else if (said.option == "scale-gain") {
      ranges.push_back(factor_range(SweepParameter::gain, said.words.front()));
    } else if (said.option == "stretch") {
      ranges.push_back(factor_range(SweepParameter::stretch, said.words.front()));
    } else {
      continue;
    }
    const SweepRange& range = ranges.back();
    const bool is_backwards = static_cast<int128>(range.to.numerator) * range.from.denominator <
                              static_cast<int128>(range.from.numerator) * range.to.denominator;
    if (range.step.numerator <= 0 || is_backwards) {
      throw UsageError(format("--{} '{}' is empty; FROM must not be above TO, STEP must be above 0",
                              said.option, said.words.front()));
    }
  }
  if (ranges.empty()) {
    throw UsageError(
        "what is varied? Add --shift 0..1s/0.1s, --scale-gain 0.5..2/0.25 or --stretch 0.5..2/0.5");
  }
  if (ranges.size() > 2) {
    throw UsageError("three parameters do not fit a sheet; vary one, or two as rows and columns");
  }
  std::uint64_t pictures = 1;
  for (const SweepRange& range : ranges) {
    const std::uint64_t count = range.count();
    if (count > kMostOnASheet || pictures * count > kMostOnASheet) {
      throw UsageError(format("a sheet holds {} pictures and this sweep makes {}{}; take a larger STEP",
                              kMostOnASheet, pictures > 1 ? format("{} x ", pictures) : "", count));
    }
    pictures *= count;
  }
  return ranges;
}

FunctionSet varied(const FunctionSet& functions, const SweepRange& range, std::uint64_t number,
                   const Timeline& timeline) {
  const Rational value = range.value(number);
  FunctionSet result;
  if (range.parameter == SweepParameter::gain) {
    for (const auto& [tag, function] : functions) result.emplace(tag, function.scaled(value.value()));
    return result;
  }
  if (range.parameter == SweepParameter::shift) {
    const Rational rate = timeline.rate();
    // A whole number of nanoseconds, or periods of the clip.
    const std::int64_t by_ns =
        range.unit_ns == 0
            ? round_half_up(static_cast<int128>(value.numerator) * rate.denominator * 1'000'000'000,
                            static_cast<int128>(value.denominator) * rate.numerator)
            : value.numerator;
    for (const auto& [tag, function] : functions) result.emplace(tag, function.shifted(by_ns));
    return result;
  }
  std::int64_t fixed_ns = timeline.duration_ns();
  for (const auto& [tag, function] : functions) {
    const GainSummary summary = summarize(function, timeline.duration_ns());
    if (summary.support_ns > 0) fixed_ns = std::min(fixed_ns, summary.live.begin_ns);
  }
  for (const auto& [tag, function] : functions) result.emplace(tag, function.stretched(value, fixed_ns));
  return result;
}

}  // namespace nutik::app
