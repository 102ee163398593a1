#include "studio/time/typed_numbers.hpp"

#include <array>
#include <cstdlib>
#include <string>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/function_numbers.hpp"
#include "exposure/normalization.hpp"
#include "exposure/shutter_shape.hpp"
#include "session/requests/stated_time.hpp"

namespace nutik::studio {
namespace {

QString text_of(const std::string& text) { return QString::fromStdString(text); }

std::string without_blanks(QString text) {
  return text.remove(QChar::Space).remove(QChar::Tabulation).remove(QChar::Nbsp).toStdString();
}

Typed<std::int64_t> within_reach(std::int64_t time_ns, const QString& what) {
  if (std::abs(time_ns) <= kLargestTimeNs) return {time_ns, {}};
  return {std::nullopt, QString("%1 lies further than 126 years from the start of the capture").arg(what)};
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

Typed<std::int64_t> read_typed_time(const QString& text, const QString& what, const Timeline& timeline) {
  try {
    const StatedTime time = StatedTime::parse(without_blanks(text), what.toStdString());
    return within_reach(moment_ns(time, timeline), what);
  } catch (const UsageError& error) {
    return {std::nullopt, text_of(error.what())};
  }
}

Typed<std::int64_t> read_typed_length(const QString& text, const QString& what, const Timeline& timeline) {
  try {
    const StatedTime time = StatedTime::parse(without_blanks(text), what.toStdString());
    const Exposure interval = plain_interval(StatedTime::of_nanoseconds(0), time, timeline);
    return within_reach(interval.end_ns - interval.start_ns, what);
  } catch (const UsageError& error) {
    return {std::nullopt, text_of(error.what())};
  }
}

QString gain_text(double gain) { return text_of(format("{}", gain)); }

Typed<double> read_typed_gain(const QString& text) {
  const auto read = read_gain(without_blanks(text));
  if (!read.mistake.empty()) return {std::nullopt, text_of(read.mistake)};
  return {read.value, {}};
}

}  // namespace nutik::studio
