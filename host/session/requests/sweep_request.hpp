// A sweep, as it is asked for: one or two parameters of gain functions, each over a range.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "capture/rational.hpp"
#include "capture/timeline.hpp"
#include "render/render_plan.hpp"

namespace nutik {

enum class SweepParameter { shift, gain, stretch };

// A parameter's values: from, from + step, … up to `to`. step > 0, from <= to; numerators of at most nine digits and
// denominators of at most six; of nanoseconds numerators of at most 15, or whole ones.
struct SweepRange {
  SweepParameter parameter = SweepParameter::shift;
  Rational from;
  Rational to;
  Rational step{1, 1};
  bool counts_pictures = false;  // of shifts; else nanoseconds

  // `0..1s/0.1s`, `-5f..5f/1f`; of factors `0.5..2/0.25`. Throws UsageError naming `what`.
  static SweepRange parse(SweepParameter parameter, const std::string& text, std::string_view what);
  [[nodiscard]] std::uint64_t count() const;
  // The value with a number of 0 … count() - 1, exactly.
  [[nodiscard]] Rational value(std::uint64_t number) const;
  // That of a shift in time, rounded once.
  [[nodiscard]] std::int64_t shift_ns(std::uint64_t number) const;
  // `+100 ms`, `−3 f`, `gain × 0.5`; `as it is` where nothing is shifted.
  [[nodiscard]] std::string label(std::uint64_t number) const;

  friend bool operator==(const SweepRange&, const SweepRange&) = default;
};

// One picture of a sweep: the number of its value in each range.
using SweepPoint = std::vector<std::uint64_t>;

struct SweepRequest {
  std::vector<SweepRange> ranges;  // one, or two as columns and rows

  // Every combination of values; those of the first range run fastest.
  [[nodiscard]] std::vector<SweepPoint> points() const;
  [[nodiscard]] std::string label(const SweepPoint& point) const;
  // The functions with a point's values applied, range by range. Stretches keep the place at which the first of the
  // functions as they are given begins to expose; pictures of the clip are periods of its mean rate.
  [[nodiscard]] FunctionSet varied(FunctionSet functions, const SweepPoint& point,
                                   const Timeline& timeline) const;

  friend bool operator==(const SweepRequest&, const SweepRequest&) = default;
};

}  // namespace nutik
