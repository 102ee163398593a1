// Times as people write them, in one grammar for options, tables and function files.
//
//   0.4s  10ms  250us  1/30s  -2e-3s  2min    a number and its unit
//   1/100                                     a fraction of a second
//   0:01.5  1:02:03                           minutes or hours before the seconds
//   37f                                       pictures of the clip, as they were filmed
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "capture/frame_times.hpp"
#include "capture/rational.hpp"

namespace nutik {

// A time, exactly. `400ms` equals `0.4s`; pictures equal pictures only, for how long they are is known of a timeline
// alone.
struct StatedTime {
  Rational number;
  std::int64_t unit_ns = kSecondNs;  // 0: pictures of the clip

  // Nothing where the text is none, or has more than 15 digits.
  static std::optional<StatedTime> read(std::string_view text);
  // The same, at most 126 years; of pictures only where `may_count`. Throws UsageError naming `what`.
  static StatedTime parse(std::string_view text, std::string_view what, bool may_count = true);
  // In the coarsest unit that holds it in whole numbers.
  static StatedTime of_nanoseconds(std::int64_t nanoseconds);
  static StatedTime of_pictures(std::int64_t count) { return {{count, 1}, 0}; }
  // Exactly, where 15 digits above and 15 below the fraction line hold it; else the nearest nanosecond.
  static StatedTime of(const ExactTime& time);

  [[nodiscard]] bool counts_samples() const { return unit_ns == 0; }
  // Whether it is longer than 126 years, to either side.
  [[nodiscard]] bool is_longest() const;
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

}  // namespace nutik
