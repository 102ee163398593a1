// Times as people state them: in seconds and parts of it, or in pictures of the clip.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "capture/frame_times.hpp"
#include "capture/rational.hpp"
#include "capture/timeline.hpp"

namespace nutik {

// `0.4s`, `10ms`, `250us`, `1/100s`, `37f`: a number and its unit, exactly. `400ms` equals `0.4s`; pictures equal
// pictures only, for how long they are is known of a timeline alone.
struct StatedTime {
  Rational number;
  std::int64_t unit_ns = kSecondNs;  // 0: pictures of the clip

  // Throws UsageError naming `what` where the text is none of these.
  static StatedTime parse(std::string_view text, std::string_view what);
  // In the coarsest unit that holds it in whole numbers.
  static StatedTime of_nanoseconds(std::int64_t nanoseconds);
  static StatedTime of_pictures(std::int64_t count) { return {{count, 1}, 0}; }
  // Exactly, where 15 digits above and 15 below the fraction line hold it; else the nearest nanosecond.
  static StatedTime of(const ExactTime& time);

  [[nodiscard]] bool counts_samples() const { return unit_ns == 0; }
  // For a time in seconds or parts of it; nanoseconds() is rounded half up.
  [[nodiscard]] ExactTime exact_nanoseconds() const {
    return {static_cast<int128>(number.numerator) * unit_ns, number.denominator};
  }
  [[nodiscard]] std::int64_t nanoseconds() const;
  // Exactly, where 15 digits above and six below the fraction line hold it; else rounded.
  [[nodiscard]] Rational modest_nanoseconds() const;
  // As parse() reads it: `0.4s`, `37f`.
  [[nodiscard]] std::string text() const;

  friend bool operator==(const StatedTime& a, const StatedTime& b);
};

// An interval's ends, each rounded half up once from its exact value. `3f` from `37f`: from the start of picture 37's
// exposure to the end of picture 39's; after a start in seconds, three periods. Throws UsageError if it is not longer
// than nothing or a picture is not there.
[[nodiscard]] Exposure plain_interval(const StatedTime& start, const StatedTime& length,
                                      const Timeline& timeline);
// The same from a moment, which is no picture's: lengths in pictures are periods.
[[nodiscard]] Exposure plain_interval(const ExactTime& start, const StatedTime& length,
                                      const Timeline& timeline);

// How long `count` periods are from the picture at a time, within the capture. Throws UsageError where it ends before.
[[nodiscard]] ExactTime periods_from(std::int64_t time_ns, std::int64_t count, const Timeline& timeline);

// The picture at a time: `37f`, or the last whose exposure begins no later than the time. Throws UsageError
// naming `what` where the time lies outside the capture.
[[nodiscard]] std::uint64_t sample_at(const StatedTime& time, std::string_view what,
                                      const Timeline& timeline);
// The last picture whose exposure begins no later than that, within the capture.
[[nodiscard]] std::uint64_t sample_at(std::int64_t time_ns, const Timeline& timeline);

// A moment on a timeline, exactly: `0.4s`, or `37f` for the start of picture 37 (as many as there are: the
// capture's end). Throws UsageError naming `what`.
[[nodiscard]] ExactTime exact_time(const StatedTime& time, std::string_view what, const Timeline& timeline);
// A moment on a timeline; that of a picture is the start of its exposure.
[[nodiscard]] std::int64_t moment_ns(const StatedTime& time, const Timeline& timeline);

}  // namespace nutik
