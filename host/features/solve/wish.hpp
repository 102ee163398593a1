// What a person wishes of a picture's light, and what may be changed for it, as text.
//
//   M0 within 500,120,80,60 gone     what moves there adds nothing
//   M64 like 0.8s                    as it is at 0.8 s, in every channel
//   R1 = 1.5 * plate                 1.5 times as bright as the scene without what moves
//   all <= 0.5                       no brighter than half of white
//
//   rest=-100..0                     bounds of a gain
//   when=0.6s..0.8s/1f               when a time may be, and in which steps
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "capture/timeline.hpp"
#include "exposure/function_template.hpp"
#include "session/requests/stated_moments.hpp"
#include "solve/bounded_least_squares.hpp"
#include "solve/gain_search.hpp"
#include "solve/time_search.hpp"

namespace nutik {

struct StatedWish {
  struct Plate {};
  struct Moment {  // the light at a time, or the mean of it between two
    StatedTime from;
    std::optional<StatedTime> to;
  };

  std::string text;
  LightRegion region;
  LightWish::Kind kind = LightWish::Kind::equal;
  double factor = 1.0;
  // What `gone` takes for the still scene: a plate or a moment.
  std::variant<double, Plate, Moment, LightRegion> target;
  double weight = 1.0;

  [[nodiscard]] bool needs_plate() const { return std::holds_alternative<Plate>(target); }
  // Whether a region is one of the exposure's mask, or of a second mask.
  [[nodiscard]] bool has_tag() const;
  [[nodiscard]] bool has_mark() const;

  // Throws UsageError naming the word that makes no sense.
  static StatedWish parse(std::string_view text);
};

struct TimeFreedom {
  StatedTime from, to;
  std::optional<StatedTime> step;  // none: see candidate_times()
};

// The range that is stated for one name of a template.
struct StatedFreedom {
  std::string name;
  std::variant<Bounds, TimeFreedom> range;

  // Throws UsageError where it is none, or the template has no such name.
  static StatedFreedom parse(std::string_view text, const FunctionTemplate& functions);
};

// Times to try for each named time, in the template's order: the stated steps; without them a picture's time apart
// (further where all together would exceed 20,000 combinations), and find_times() then looks between them. Throws
// UsageError where a time has no range, one that does not lie in the capture, or where steps make more than a million
// combinations.
[[nodiscard]] std::vector<CandidateTimes> candidate_times(const FunctionTemplate& functions,
                                                          const std::vector<StatedFreedom>& free,
                                                          const Timeline& timeline);

}  // namespace nutik
