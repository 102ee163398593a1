// An exposure, as it is asked for. A value: two are equal when they ask for the same picture of every capture.
//
//   in:      a plain interval or gain functions, when it starts, a mask, how bright it is
//   out:     for a capture's timeline and shape, the functions, mask and options that a plan is made from
//   always:  nothing is read and nothing is printed; copies share functions and mask
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "exposure/mask.hpp"
#include "exposure/normalization.hpp"
#include "exposure/shutter_shape.hpp"
#include "render/mask_map.hpp"
#include "render/render_plan.hpp"
#include "session/requests/delay_request.hpp"
#include "session/requests/stated_moments.hpp"
#include "system/shared.hpp"

namespace nutik {

// A length of time during which a shutter opens and closes.
struct PlainInterval {
  StatedTime length;
  Shutter shutter;
  friend bool operator==(const PlainInterval&, const PlainInterval&) = default;
};

// A mask, and the functions that it uses.
struct MaskWithRegions {
  explicit MaskWithRegions(Mask of) : mask(std::move(of)), regions(regions_of(mask)) {}

  [[nodiscard]] bool uses(std::uint8_t tag) const {
    return std::ranges::binary_search(regions, tag, {}, &MaskRegion::tag);
  }

  Mask mask;
  std::vector<MaskRegion> regions;
  friend bool operator==(const MaskWithRegions& a, const MaskWithRegions& b) { return a.mask == b.mask; }
};

// `integral`, `mean`, `lighten`, `darken`, `median`: the mean is the integral, divided by that of the gain.
struct Combining {
  Combine how = Combine::integral;
  bool is_mean = false;

  static Combining parse(std::string_view text);
};

struct ExposureRequest {
  // Functions as they were written, by mask value: at least one; without a mask exactly one.
  std::variant<PlainInterval, Shared<FunctionSet>> gains;
  StatedTime start;  // of the interval; of functions, their time 0
  std::optional<Shared<MaskWithRegions>> mask;
  std::optional<DelayRequest> delay;  // of each pixel; its picture, if it is one, has been read
  Normalization normalization;
  double gain = 1.0;  // multiplies the light
  PlanOptions plan;   // without its delays and its functions' name, which follow from the above

  [[nodiscard]] bool is_plain() const { return std::holds_alternative<PlainInterval>(gains); }
  friend bool operator==(const ExposureRequest&, const ExposureRequest&) = default;
};

// The functions for a capture of this timeline, normalized and as bright as asked for: those that the mask uses.
// Throws UsageError if a plain interval lies outside the capture or is too short for its shutter, InputError if a
// function cannot be normalized.
[[nodiscard]] FunctionSet functions_of(const ExposureRequest& request, const Timeline& timeline);
// The same with an interval in nanoseconds in place of the stated one. Functions have their time 0 at its start; its
// end says nothing to them.
[[nodiscard]] FunctionSet functions_of(const ExposureRequest& request, const Exposure& interval,
                                       const Timeline& timeline);

// The last time at which functions gather light, counted from their time 0.
[[nodiscard]] std::int64_t functions_end_ns(const ExposureRequest& request);

// The mask for a picture of this shape; without a stated one, tag 0 everywhere.
[[nodiscard]] Mask mask_of(const ExposureRequest& request, const Shape& shape);

// For pictures of this shape. Throws as delays_of() does.
[[nodiscard]] PlanOptions plan_options_of(const ExposureRequest& request, const Shape& shape);

}  // namespace nutik
