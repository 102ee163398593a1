// Times as people write them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "capture/frame_times.hpp"
#include "capture/rational.hpp"
#include "capture/timeline.hpp"

namespace nutik::app {

// `0.4s`, `10ms`, `250us`, `1/100s`, `37f`: a number and its unit, exactly.
struct TimeText {
  Rational number;
  std::int64_t unit_ns = 0;  // 0: pictures of the clip

  // Throws UsageError naming `what` where the text is none of these.
  static TimeText parse(std::string_view text, std::string_view what);

  [[nodiscard]] bool counts_samples() const { return unit_ns == 0; }
  // Rounded half up. For a time in seconds or parts of it.
  [[nodiscard]] std::int64_t nanoseconds() const;
  // `0.4s` or `37f`, as parse() reads it. For a time of whole nanoseconds: `400ms`.
  [[nodiscard]] std::string text() const;
  static TimeText of_nanoseconds(std::int64_t nanoseconds) { return {{nanoseconds, 1}, 1}; }
};

// When the plain interval that --start and --exposure describe begins and ends on a timeline. From `37f`
// for `3f` is from the start of picture 37's exposure to the end of picture 39's, so that one picture is
// exactly what the camera exposed; `3f` after a start at 0.4s is as long as three periods there.
// The times are in `from` and `length`; throws UsageError where pictures are counted that the timeline lacks.
Exposure plain_interval(const TimeText& from, const TimeText& length, const Timeline& timeline);
Exposure plain_interval(std::string_view start, std::string_view exposure, const Timeline& timeline);

// The picture at a time: `37f`, or the last whose exposure begins no later than the time. Throws UsageError
// naming `what` where the time lies outside the capture.
[[nodiscard]] std::uint64_t sample_at(std::string_view text, std::string_view what, const Timeline& timeline);
// A moment on a timeline, exactly: `0.4s`, or `37f` for the start of picture 37 (as many as there are: the
// capture's end). Throws UsageError naming `what`.
[[nodiscard]] ExactTime exact_time(std::string_view text, std::string_view what, const Timeline& timeline);
// A moment on a timeline; that of a picture is the start of its exposure.
[[nodiscard]] std::int64_t moment_ns(const TimeText& time, const Timeline& timeline);

// `12.5 ms`, `1.25 s`: a length for people, with up to four digits.
[[nodiscard]] std::string duration_text(std::int64_t nanoseconds);

// `750 ms`, `-1.01 s`: a time, or the integral of a gain over time, with up to six digits.
[[nodiscard]] std::string integral_text(double nanoseconds);

}  // namespace nutik::app
