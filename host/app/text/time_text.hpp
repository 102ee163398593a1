// Times as people write them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

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
};

// When the plain interval that --start and --exposure describe begins and ends on a timeline. From `37f`
// for `3f` is from the start of picture 37's exposure to the end of picture 39's, so that one picture is
// exactly what the camera exposed; `3f` after a start at 0.4s is as long as three periods there.
Exposure plain_interval(std::string_view start, std::string_view exposure, const Timeline& timeline);

// `12.5 ms`, `1.25 s`: a length for people, with up to four digits.
[[nodiscard]] std::string duration_text(std::int64_t nanoseconds);

}  // namespace nutik::app
