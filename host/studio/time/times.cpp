#include "studio/time/times.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/function_numbers.hpp"
#include "session/requests/stated_moments.hpp"
#include "studio/time/time_axis.hpp"

namespace nutik::studio {
namespace {

QString text_of(const std::string& text) { return QString::fromStdString(text); }

// Without blanks, and a comma as a decimal point.
std::string typed_number(QString text) {
  return text.remove(QChar::Space)
      .remove(QChar::Tabulation)
      .remove(QChar::Nbsp)
      .replace(',', '.')
      .toStdString();
}

// What the engine refuses is said in the window's language. `time_of` throws UsageError for pictures that are absent.
Typed<std::int64_t> read_typed(const QString& text, const Timeline& timeline,
                               std::int64_t (*time_of)(const StatedTime&, const Timeline&)) {
  std::optional<StatedTime> time;
  try {
    time = StatedTime::parse(typed_number(text), {});
    const std::int64_t time_ns = time_of(*time, timeline);
    if (std::abs(time_ns) <= kLargestTimeNs) return {time_ns, {}};
  } catch (const UsageError&) {
  }
  if (time && time->counts_samples())
    return {std::nullopt, TimeAxis::tr("'%1' is outside the capture, which has %2 pictures, or is no whole number")
                              .arg(text.trimmed()).arg(timeline.pictures().sample_count())};
  return {std::nullopt, TimeAxis::tr("'%1' is no time of up to 126 years; write a number and a unit: 0.4 s, 10 ms, "
                                     "1/100 s or 37f").arg(text.trimmed())};
}

}  // namespace

QString exact_time_text(std::int64_t time_ns) {
  struct Unit {
    const char* name;
    std::int64_t ns;
    int decimals;
  };
  constexpr std::array<Unit, 4> kUnits{
      {{"s", 1'000'000'000, 9}, {"ms", 1'000'000, 6}, {"µs", 1'000, 3}, {"ns", 1, 0}}};
  const std::int64_t magnitude = std::abs(time_ns);
  if (magnitude == 0) return "0 s";
  const Unit* unit = kUnits.data();
  while (magnitude < unit->ns) ++unit;
  std::string digits = format("{}{}", time_ns < 0 ? "-" : "", magnitude / unit->ns);
  if (magnitude % unit->ns != 0) {
    digits += format(".{:0{}}", magnitude % unit->ns, unit->decimals);
    digits.erase(digits.find_last_not_of('0') + 1);
  }
  return text_of(digits + " " + unit->name);
}

Typed<std::int64_t> read_typed_time(const QString& text, const Timeline& timeline) {
  return read_typed(text, timeline, moment_ns);
}

Typed<std::int64_t> read_typed_length(const QString& text, const Timeline& timeline) {
  const auto read = read_typed(text, timeline, [](const StatedTime& time, const Timeline& of) {
    if (time.number.numerator <= 0) return std::int64_t{0};
    const Exposure interval = plain_interval(StatedTime::of_nanoseconds(0), time, of);
    return interval.end_ns - interval.start_ns;
  });
  if (read.value != 0) return read;
  return {std::nullopt, TimeAxis::tr("'%1' is not longer than nothing").arg(text.trimmed())};
}

QString gain_text(double gain) { return text_of(format("{}", gain)); }

Typed<double> read_typed_gain(const QString& text) {
  const auto read = read_gain(typed_number(text));
  if (!read.mistake.empty())
    return {std::nullopt,
            TimeAxis::tr("'%1' is no gain; write a number such as 1, -0.5 or 2e-3").arg(text.trimmed())};
  return {read.value, {}};
}

QString typed_time_help() {
  return TimeAxis::tr("A number and its unit: 0.4 s, 10 ms, 250 us, 1/100 s, or 37f for the start of picture 37");
}

std::int64_t nearest_sample_edge(std::int64_t time_ns, const Timeline& timeline) {
  const Timeline& pictures = timeline.pictures();
  const SampleTimes a = pictures.times(sample_at(time_ns, pictures));
  const SampleTimes b = timeline.times(sample_at(time_ns, timeline));
  return std::min({a.before_ns, a.start_ns, a.end_ns, a.after_ns, b.before_ns, b.start_ns, b.end_ns, b.after_ns},
                  [&](std::int64_t x, std::int64_t y) { return std::abs(x - time_ns) < std::abs(y - time_ns); });
}

std::optional<std::uint64_t> picture_at(std::int64_t time_ns, const Timeline& timeline) {
  const Timeline& pictures = timeline.pictures();
  const std::uint64_t picture = sample_at(time_ns, pictures);
  if (pictures.start_ns(picture) == time_ns || pictures.end_ns(picture) == time_ns + 1) return picture;
  return timeline.picture_of(sample_at(time_ns, timeline));
}

QString sample_text(std::int64_t time_ns, const Timeline& timeline) {
  if (const auto picture = picture_at(time_ns, timeline)) return TimeAxis::tr("picture %1").arg(*picture);
  return TimeAxis::tr("made sample at %1").arg(exact_time_text(timeline.start_ns(sample_at(time_ns, timeline))));
}

QString edge_text(std::int64_t edge_ns, const Timeline& timeline) {
  const Timeline& pictures = timeline.pictures();
  const std::uint64_t sample = sample_at(edge_ns, timeline);
  const bool begins = pictures.start_ns(sample_at(edge_ns, pictures)) == edge_ns ||
                      (timeline.start_ns(sample) == edge_ns && !timeline.picture_of(sample));
  return begins ? TimeAxis::tr("start of %1").arg(sample_text(edge_ns, timeline))
                : TimeAxis::tr("end of %1").arg(sample_text(edge_ns - 1, timeline));
}

}  // namespace nutik::studio
