#include "features/sheets/sheet_request.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/function_text.hpp"
#include "exposure/gain_function.hpp"
#include "session/requests/stated_moments.hpp"
#include "session/text/number_text.hpp"
#include "sheet/contact_sheet.hpp"

namespace nutik {
namespace {

constexpr std::uint64_t kDefaultCount = 24;

void check_count(int128 count, const StatedTime& every, std::int64_t span_ns) {
  if (count <= static_cast<int128>(sheet::kMaxPictures)) return;
  constexpr auto kMax = static_cast<std::int64_t>(sheet::kMaxPictures);
  std::int64_t min_ns = std::max<std::int64_t>((span_ns - 1) / kMax + 1, 1);
  std::int64_t unit_ns = 1;
  while (min_ns / unit_ns >= 1000) unit_ns *= 10;
  min_ns = (min_ns + unit_ns - 1) / unit_ns * unit_ns;
  const std::string least = StatedTime::of_nanoseconds(min_ns).text();
  throw UsageError(Advice{format(
      "`every {}` makes {} pictures and a sheet holds {}; take `every {}` or more, or begin later with `start`",
      every.text(), static_cast<std::uint64_t>(std::min<int128>(count, INT64_MAX)), sheet::kMaxPictures, least)});
}

std::vector<ExactTime> starts_of(const ContactRequest& request, const Timeline& timeline) {
  const std::uint64_t first = sample_at(request.start, "start", timeline);
  std::vector<ExactTime> starts;
  if (!request.every || request.every->counts_samples()) {
    const std::uint64_t samples = timeline.sample_count() - first;
    const std::uint64_t stride = request.every ? static_cast<std::uint64_t>(request.every->number.numerator)
                                               : (samples + kDefaultCount - 1) / kDefaultCount;
    if (request.every) {
      check_count((samples + stride - 1) / stride, *request.every,
                  timeline.duration_ns() - timeline.start_ns(first));
    }
    for (std::uint64_t k = first; k < timeline.sample_count(); k += stride)
      starts.push_back(ExactTime::of_sample(timeline, k));
    return starts;
  }
  const StatedTime& every = *request.every;
  const std::int64_t start_ns = moment_ns(request.start, timeline);
  const std::int64_t span_ns = timeline.duration_ns() - start_ns;
  const int128 step = static_cast<int128>(every.number.numerator) * every.unit_ns;
  const int128 count = (static_cast<int128>(span_ns) * every.number.denominator + step - 1) / step;
  check_count(count, every, span_ns);
  const ExactTime start = exact_time(request.start, "start", timeline);
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(count); ++i) {
    const ExactTime at = start + ExactTime{i * step, every.number.denominator};
    if (round_half_up(at.numerator, at.denominator) < timeline.duration_ns()) starts.push_back(at);
  }
  return starts;
}

// As plain_interval has it; pictures that the capture no longer has may be counted, too. How far an exposure passes
// the end is all the same, as long as it does: a warning then says so.
Exposure interval_from(const ExactTime& start, const StatedTime& length, const Timeline& timeline) {
  const std::int64_t start_ns = round_half_up(start.numerator, start.denominator);
  if (length.counts_samples() && length.number.denominator == 1) {
    const std::uint64_t left = timeline.sample_count() - sample_at(start_ns, timeline);
    if (length.number.numerator > static_cast<std::int64_t>(left))
      return {start_ns, timeline.duration_ns() + 1};
  }
  return plain_interval(start, length, timeline);
}

}  // namespace

std::vector<Exposure> exposures_of(const ContactRequest& request, const Timeline& of_capture) {
  const Timeline& timeline = of_capture.pictures();
  std::vector<Exposure> exposures;
  for (const ExactTime& start : starts_of(request, timeline)) {
    if (request.length) {
      exposures.push_back(interval_from(start, *request.length, timeline));
    } else {
      const std::uint64_t sample = sample_at(round_half_up(start.numerator, start.denominator), timeline);
      exposures.push_back({timeline.start_ns(sample), timeline.end_ns(sample)});
    }
  }
  return exposures;
}

std::vector<std::string> labels_of(const std::vector<Exposure>& exposures, const Timeline& timeline) {
  struct Unit {
    const char* name;
    double nanoseconds;
  };
  const auto last = static_cast<double>(exposures.back().start_ns);
  constexpr double kHour = 3600e9;
  const Unit unit = last >= 1000 * kHour ? Unit{"days", 24 * kHour}
                    : last >= 10 * kHour ? Unit{"h", kHour}
                    : last >= 1e9        ? Unit{"s", 1e9}
                    : last >= 1e6        ? Unit{"ms", 1e6}
                    : last >= 1e3        ? Unit{"µs", 1e3}
                                         : Unit{"ns", 1};
  const double step = exposures.size() < 2
                          ? unit.nanoseconds
                          : static_cast<double>(exposures[1].start_ns - exposures[0].start_ns);
  const int decimals =
      static_cast<int>(std::clamp(1.0 - std::floor(std::log10(std::max(step, 1.0) / unit.nanoseconds)), 0.0,
                                  std::log10(unit.nanoseconds)));
  std::vector<std::string> labels;
  labels.reserve(exposures.size());
  for (const Exposure& exposure : exposures) {
    labels.push_back(format("{:.{}f} {}   {}f", static_cast<double>(exposure.start_ns) / unit.nanoseconds,
                            decimals, unit.name, sample_at(exposure.start_ns, timeline.pictures())));
  }
  return labels;
}

namespace {

// The functions so many pictures later: from one to the next where times are irregular.
FunctionSet pictures_later(ExposureRequest request, std::int64_t pictures, const Timeline& of_capture) {
  const Timeline& timeline = of_capture.pictures();
  const std::int64_t start_ns = moment_ns(request.start, timeline);
  const Rational rate = timeline.rate();
  const std::int64_t by_ns =
      timeline.is_constant() ? round_half_up(int128{pictures} * rate.denominator * kSecondNs, rate.numerator)
                             : samples_later(start_ns, pictures, timeline) - start_ns;
  const auto* const plain = std::get_if<PlainInterval>(&request.gains);
  if (plain != nullptr && !timeline.is_constant() && request.start.counts_samples() && plain->length.counts_samples()) {
    const std::int64_t first = request.start.number.numerator + pictures;
    const std::int64_t last = first + plain->length.number.numerator - 1;
    if (first >= 0 && last < static_cast<std::int64_t>(timeline.sample_count())) {
      request.start = StatedTime::of_pictures(first);
      return functions_of(request, timeline);
    }
  }
  FunctionSet functions = functions_of(request, timeline);
  for (auto& [tag, function] : functions) function = function.shifted(by_ns);
  return functions;
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
  if (range.parameter == SweepParameter::shift)
    return each([&](const GainFunction& function) { return function.shifted(range.shift_ns(number)); });
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
  // What require_modest() lets pass holds, so often added: 4e17 at most.
  const auto [numerator, denominator] = exact_value(*this, number);
  return Rational::of(static_cast<std::int64_t>(numerator), static_cast<std::int64_t>(denominator));
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

FunctionSet SweepRequest::varied(const ExposureRequest& request, const SweepPoint& point,
                                 const Timeline& timeline) const {
  std::int64_t pictures = 0;
  for (std::size_t i = 0; i < ranges.size(); ++i)
    if (ranges[i].counts_pictures) pictures += ranges[i].value(point[i]).numerator;
  FunctionSet functions = pictures_later(request, pictures, timeline);
  for (std::size_t i = 0; i < ranges.size(); ++i)
    if (!ranges[i].counts_pictures) functions = with_value(functions, ranges[i], point[i], timeline);
  return functions;
}

namespace {

// The interval from the function's first point to its last, as bright as the function.
std::optional<OwnInterval> own_interval(const FunctionSet& functions, ExposureRequest request,
                                        const Timeline& timeline) {
  const auto points = functions.begin()->second.points();
  auto& plain = std::get<PlainInterval>(request.gains);
  request.start = StatedTime::of_nanoseconds(points.front().time_ns);
  plain.length = StatedTime::of_nanoseconds(points.back().time_ns - points.front().time_ns);
  request.normalization = {};
  request.gain = 1.0;
  try {
    const FunctionSet made = functions_of(request, timeline);
    const auto made_points = made.begin()->second.points();
    if (made_points.size() != points.size()) return std::nullopt;
    const auto strongest = std::ranges::max_element(
        made_points, {}, [](const ControlPoint& point) { return std::fabs(point.gain); });
    request.gain = points[static_cast<std::size_t>(strongest - made_points.begin())].gain / strongest->gain;
    if (functions_of(request, timeline) != functions) return std::nullopt;
  } catch (const UsageError&) {  // no gain in the capture, or an interval that is too short for the shutter
    return std::nullopt;
  }
  return OwnInterval{request.start, plain.length, request.gain};
}

}  // namespace

std::optional<OwnExposure> own_exposure(const FunctionSet& functions, const ExposureRequest& request,
                                        const Timeline& timeline, const std::string& functions_name) {
  if (request.is_plain()) {
    if (const auto interval = own_interval(functions, request, timeline)) return *interval;
  }
  std::string text;
  for (const auto& [tag, function] : functions) {
    const auto points = function.points();
    const bool jumps = std::ranges::adjacent_find(points, {}, &ControlPoint::time_ns) != points.end();
    if (jumps) return std::nullopt;
    text += function_text(tag, function) + "\n";
  }
  return Recipe::Text{functions_name, std::move(text)};
}

}  // namespace nutik
