#include "session/requests/film_curve.hpp"

#include <algorithm>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/between.hpp"
#include "session/requests/key_frames.hpp"
#include "session/text/time_text.hpp"

namespace nutik {
namespace {

std::string_view without_blanks(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

FilmCurve::Point parse_point(std::string_view line, const FrameTimes& film) {
  const auto comma = line.find(',');
  if (comma == std::string_view::npos || line.find(',', comma + 1) != std::string_view::npos) {
    throw UsageError(
        format("'{}' is no point; write a time of the film and one of the capture: 1.5s,0.4s", line));
  }
  const auto film_time = StatedTime::parse(without_blanks(line.substr(0, comma)), "the film's time");
  return {film_moment_ns(film_time, "the film's time", film),
          StatedTime::parse(without_blanks(line.substr(comma + 1)), "the capture's time")};
}

void check_order(const std::vector<FilmCurve::Point>& points) {
  const std::int64_t last_ns = points.back().film_ns;
  if (points.size() == 1) {
    if (last_ns == 0) return;
    throw UsageError(format("the first point is at {} of the film; a curve begins at 0s", duration_text(last_ns)));
  }
  const std::int64_t before_ns = points[points.size() - 2].film_ns;
  if (last_ns > before_ns) return;
  throw UsageError(format("the film's time {} is not after {}; points are in order of the film's time",
                          duration_text(last_ns), duration_text(before_ns)));
}

}  // namespace

FilmCurve FilmCurve::parse(std::string_view text, const std::string& title, const FrameTimes& film) {
  if (text.find('\0') != std::string_view::npos) {
    throw InputError(format("{} holds a zero byte: this is no text file, or one in UTF-16; save it as UTF-8", title));
  }
  if (constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF"; text.starts_with(kByteOrderMark)) {
    text.remove_prefix(kByteOrderMark.size());  // spreadsheets write it
  }
  FilmCurve curve{title, {}};
  std::size_t number = 0;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view whole = text.substr(begin, end - begin);
    const std::string_view line = without_blanks(whole.substr(0, whole.find('#')));
    begin = end + 1;
    ++number;
    if (line.empty()) continue;
    try {
      curve.points.push_back(parse_point(line, film));
      check_order(curve.points);
    } catch (const UsageError& error) {
      throw InputError(format("{}:{}: {}", title, number, error.what()));
    }
  }
  if (curve.points.size() < 2) {
    throw InputError(
        format("{} is too short, with {} of the points that a curve has: two or more, a line each: 0s,0.2s and 2s,0.7s show half a second "
               "of the capture in two of the film",
               title, curve.points.size()));
  }
  return curve;
}

CapturedCurve::CapturedCurve(const FilmCurve& curve, const Timeline& timeline, std::int64_t min_ns)
    : duration_ns_(timeline.duration_ns()), min_ns_(std::min(min_ns, timeline.duration_ns())) {
  for (const FilmCurve::Point& point : curve.points) {
    try {
      const ExactTime time = exact_time(point.capture, "the capture's time", timeline);
      points_.push_back({point.film_ns, round_half_up(time.numerator, time.denominator)});
    } catch (const UsageError& error) {
      throw UsageError(format("{}: {}", curve.name, error.what()));
    }
  }
}

std::int64_t CapturedCurve::time_ns(std::int64_t film_ns) const {
  const auto next = std::ranges::upper_bound(points_, film_ns, {}, &Point::film_ns);
  if (next == points_.begin()) return points_.front().capture_ns;
  const auto before = next - 1;
  if (next == points_.end()) return before->capture_ns;
  return time_between(before->capture_ns, next->capture_ns,
                      {film_ns - before->film_ns, next->film_ns - before->film_ns});
}

Exposure CapturedCurve::passed(const Exposure& film) const {
  const std::int64_t first = time_ns(film.start_ns), last = time_ns(film.end_ns);
  Exposure passed{std::min(first, last), std::max(first, last)};
  for (const Point& point : points_) {  // it may turn round meanwhile
    if (point.film_ns <= film.start_ns || point.film_ns >= film.end_ns) continue;
    passed.start_ns = std::min(passed.start_ns, point.capture_ns);
    passed.end_ns = std::max(passed.end_ns, point.capture_ns);
  }
  return passed;
}

Exposure CapturedCurve::exposure(const Exposure& film) const {
  Exposure exposure = passed(film);
  exposure.start_ns = std::clamp<std::int64_t>(exposure.start_ns, 0, duration_ns_);
  exposure.end_ns = std::clamp<std::int64_t>(exposure.end_ns, 0, duration_ns_);
  if (exposure.end_ns - exposure.start_ns >= min_ns_) return exposure;
  const std::int64_t start_ns = std::min(exposure.start_ns, duration_ns_ - min_ns_);
  return {start_ns, start_ns + min_ns_};
}

bool CapturedCurve::leaves(const Exposure& film) const {
  const Exposure range = passed(film);
  return range.start_ns < 0 || range.end_ns > duration_ns_;
}

}  // namespace nutik
