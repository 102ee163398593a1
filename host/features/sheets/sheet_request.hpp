// What sheets show, as it is asked for: moments one after another (contact), or one exposure varied (sweep).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "capture/error.hpp"
#include "capture/rational.hpp"
#include "capture/timeline.hpp"
#include "media/writers/recipe.hpp"
#include "render/render_plan.hpp"
#include "session/requests/exposure_request.hpp"
#include "session/requests/stated_moments.hpp"

namespace nutik {

struct ContactRequest {
  StatedTime start;
  std::optional<StatedTime> every;   // longer than nothing; pictures are whole ones. None: so that 24 fit
  std::optional<StatedTime> length;  // of each. None: what the camera exposed at that time
};

// Sample by sample where pictures are counted or nothing is stated, else at exact multiples of a time. An exposure
// may go on behind the capture's end. Throws UsageError where they are more than a sheet has room for, or the start
// lies outside.
[[nodiscard]] std::vector<Exposure> exposures_of(const ContactRequest& request, const Timeline& timeline);

// `0.4 s   12f` for each exposure: times in one unit, with the decimals that tell neighbours apart, and the picture
// of the clip.
[[nodiscard]] std::vector<std::string> labels_of(const std::vector<Exposure>& exposures,
                                                 const Timeline& timeline);

// A sweep, as it is asked for: one or two parameters of gain functions, each over a range.
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
  // The value with a number of 0 … count() - 1, exactly: of a factor, or of counted pictures.
  [[nodiscard]] Rational value(std::uint64_t number) const;
  // That of a shift in time, rounded once.
  [[nodiscard]] std::int64_t shift_ns(std::uint64_t number) const;
  // `+100 ms`, `−3 f`, `gain × 0.5`; `as it is` where nothing is shifted.
  [[nodiscard]] std::string label(std::uint64_t number) const;
};

// One picture of a sweep: the number of its value in each range.
using SweepPoint = std::vector<std::uint64_t>;

struct SweepRequest {
  std::vector<SweepRange> ranges;  // one, or two as columns and rows

  // Every combination of values; those of the first range run fastest.
  [[nodiscard]] std::vector<SweepPoint> points() const;
  [[nodiscard]] std::string label(const SweepPoint& point) const;
  // The functions with a point's values applied: first pictures of the clip, which lead from one to the next (beyond
  // the capture by its mean rate), then range by range. Stretches keep the place at which the first of the functions
  // begins to expose.
  [[nodiscard]] FunctionSet varied(const ExposureRequest& request, const SweepPoint& point,
                                   const Timeline& timeline) const;
};

// How a picture of a sweep is exposed on its own.
//
//   in:      the functions that it was exposed with, and what was varied
//   out:     what says the same without the sweep
//   always:  expose makes the same functions from it, to the last bit; where that cannot be, there is none

// A plain interval of the sweep's shutter, divided by the time with a gain.
struct OwnInterval {
  StatedTime start, length;
  double gain = 1.0;  // that light is multiplied with
};

// An interval where that makes the functions, else the text of a function file: its functions are neither normalized
// nor brightened again.
using OwnExposure = std::variant<OwnInterval, Recipe::Text>;

// The text has the name `functions_name`. None for an interval outside the capture, which expose refuses, and where
// functions jump that no interval makes, for a function file has no jumps.
[[nodiscard]] std::optional<OwnExposure> own_exposure(const FunctionSet& functions,
                                                      const ExposureRequest& request,
                                                      const Timeline& timeline,
                                                      const std::string& functions_name);

}  // namespace nutik
