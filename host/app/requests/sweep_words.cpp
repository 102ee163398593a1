#include "app/requests/requests.hpp"

#include <cstdlib>

#include "session/below/error.hpp"
#include "session/below/format.hpp"
#include "session/below/sheets.hpp"
#include "session/requests/stated_time.hpp"

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
  const StatedTime step = StatedTime::parse(parts.step, "--shift's step");
  const auto parse = [&](const std::string& part) {
    if (part == "0") return Rational{0, 1};
    const StatedTime time = StatedTime::parse(part, "--shift");
    if (time.counts_samples() != step.counts_samples())
      throw UsageError(format("--shift '{}' mixes times and pictures; use one of them", text));
    return time.counts_samples() ? time.number : time.modest_nanoseconds();
  };
  range.counts_pictures = step.counts_samples();
  range.step = step.counts_samples() ? step.number : step.modest_nanoseconds();
  range.from = parse(parts.from);
  range.to = parse(parts.to);
  if (!range.counts_pictures) return range;
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

}  // namespace

SweepRequest sweep_request(const Options& options) {
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
  if (ranges.size() > 2)
    throw UsageError("three parameters do not fit a sheet; vary one, or two as rows and columns");
  std::uint64_t pictures = 1;
  for (const SweepRange& range : ranges) {
    const std::uint64_t count = range.count();
    if (count > sheet::kMaxPictures || pictures * count > sheet::kMaxPictures) {
      throw UsageError(format("a sheet holds {} pictures and this sweep makes {}{}; take a larger STEP",
                              sheet::kMaxPictures, pictures > 1 ? format("{} x ", pictures) : "", count));
    }
    pictures *= count;
  }
  return {std::move(ranges)};
}

}  // namespace nutik::app
