// When the frames of a virtual video are exposed, in the time of the capture.
//
//   in:      where the video starts, the rate it is played at, its speed, its shutter angle
//   out:     [start_ns(k), end_ns(k)] for every frame k = 0, 1, …
//   always:  t_k = from + k · speed / rate and e_k = t_k + angle/360 · speed / rate, each rounded half up from
//            its own exact value: no frame depends on the one before, so times never drift
//
// With an angle above 360 degrees exposures overlap, below it they leave gaps. A capture's own rate and angle at
// speed 1 give its own exposures, nanosecond for nanosecond.
#pragma once

#include <cstdint>

#include "capture/rational.hpp"
#include "capture/timeline.hpp"

namespace nutik {

// A time in nanoseconds, exactly: numerator / denominator. 0 < denominator <= 10^15, |time| < 2^62.
struct ExactTime {
  int128 numerator = 0;
  int128 denominator = 1;

  // The start of sample k of a timeline, before it is rounded where the timeline has a constant rate.
  static ExactTime of_sample(const Timeline& timeline, std::uint64_t k);
};

// In lowest terms. Where that takes a denominator above 10^15, what is nearest among 10^-15 ns.
[[nodiscard]] ExactTime operator+(const ExactTime& a, const ExactTime& b);

// Rounded half up, once, from the exact sum.
[[nodiscard]] std::int64_t rounded_sum(const ExactTime& a, const ExactTime& b);
// from + (to - from) · step / steps, rounded likewise. 0 <= step <= steps < 2^16; steps > 0.
[[nodiscard]] std::int64_t rounded_between(const ExactTime& from, const ExactTime& to, std::int64_t step,
                                           std::int64_t steps);

class FrameTimes {
 public:
  // `rate` in frames a second of playback, `speed` in seconds of the capture for each second of playback
  // (1/4: four times slower than life), `angle` in degrees. Throws UsageError where one is not positive or
  // is written with more digits than times stay exact with, or a frame would be shorter than 1 ns or longer
  // than 31 years.
  FrameTimes(ExactTime from, Rational rate, Rational speed, Rational angle);

  [[nodiscard]] std::int64_t start_ns(std::uint64_t k) const { return time_ns(k, 0); }
  [[nodiscard]] std::int64_t end_ns(std::uint64_t k) const { return time_ns(k, angle_.numerator); }
  [[nodiscard]] Exposure exposure(std::uint64_t k) const { return {start_ns(k), end_ns(k)}; }

  // How many frames there are whose exposure ends by `until_ns`, or which start by it.
  [[nodiscard]] std::uint64_t count_ending_by(std::int64_t until_ns) const;
  [[nodiscard]] std::uint64_t count_starting_by(std::int64_t until_ns) const;

 private:
  // k periods and `degrees` / angle_.denominator degrees after the start.
  [[nodiscard]] std::int64_t time_ns(std::uint64_t k, std::int64_t degrees) const;
  [[nodiscard]] std::uint64_t count_by(std::int64_t until_ns, std::int64_t degrees) const;

  ExactTime from_;
  Rational period_s_;
  Rational angle_;
};

}  // namespace nutik
