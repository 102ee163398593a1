// What a sweep varies: a parameter of gain functions, over a range.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/command_line/options.hpp"
#include "app/text/time_text.hpp"
#include "capture/rational.hpp"
#include "capture/timeline.hpp"
#include "render/render_plan.hpp"

namespace nutik::app {

enum class SweepParameter { shift, gain, stretch };

// A parameter and its values, as written: `0..1s/0.1s`.
struct SweepRange {
  SweepParameter parameter = SweepParameter::shift;
  Rational from;
  Rational to;
  Rational step;
  std::int64_t unit_ns = 0;  // of shifts; 0: pictures of the clip

  [[nodiscard]] std::uint64_t count() const;
  // The value with a number of 0 … count() - 1, exactly.
  [[nodiscard]] Rational value(std::uint64_t number) const;
  // `+100 ms`, `−3 f`, `gain × 0.5`; `as it is` where nothing is shifted.
  [[nodiscard]] std::string label(std::uint64_t number) const;
};

inline constexpr std::uint64_t kMostOnASheet = 400;

// What the options vary, one or two ranges in the order of the command line; the first runs along the rows.
// Throws UsageError where there is none, there are three, or a range is empty or longer than kMostOnASheet.
[[nodiscard]] std::vector<SweepRange> sweep_ranges(const Options& options);

// The functions with a range's value applied. Stretches keep the place at which the first of the functions as
// they are given begins to expose; pictures of the clip are periods of its mean rate.
[[nodiscard]] FunctionSet varied(const FunctionSet& functions, const SweepRange& range, std::uint64_t number,
                                 const Timeline& timeline);

}  // namespace nutik::app
