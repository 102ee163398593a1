// What an exposure is asked to be, as a value: two are equal when they ask for the same picture of every capture.
//
//   in:      a plain interval or gain functions, when it starts, a mask, how bright it is
//   out:     for a capture's timeline and shape, the functions, mask and options that a plan is made from
//   always:  nothing is read and nothing is printed; copies share functions and mask
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "capture/transfer.hpp"
#include "exposure/mask.hpp"
#include "exposure/normalization.hpp"
#include "exposure/shutter_shape.hpp"
#include "render/mask_map.hpp"
#include "render/render_plan.hpp"
#include "session/shared.hpp"
#include "session/stated_time.hpp"

namespace nutik {

// As long as stated, in which a shutter opens and closes.
struct PlainInterval {
  StatedTime length;
  Shutter shutter;
  friend bool operator==(const PlainInterval&, const PlainInterval&) = default;
};

// A mask, and the functions that it uses.
struct CountedMask {
  explicit CountedMask(Mask of) : mask(std::move(of)), regions(regions_of(mask)) {}

  [[nodiscard]] bool uses(std::uint8_t tag) const {
    return std::ranges::binary_search(regions, tag, {}, &MaskRegion::tag);
  }

  Mask mask;
  std::vector<MaskRegion> regions;
  friend bool operator==(const CountedMask& a, const CountedMask& b) { return a.mask == b.mask; }
};

struct ExposureRequest {
  // Functions as they were written, by mask value: at least one, and a single one where there is no mask.
  std::variant<PlainInterval, Shared<FunctionSet>> gains;
  StatedTime start;  // of the interval; of functions, their time 0
  std::optional<Shared<CountedMask>> mask;
  Normalization normalization;
  double gain = 1.0;  // that light is multiplied with
  bool unmapped_is_zero = false;
  bool live_all = false;
  std::optional<Transfer> transfer;  // instead of the capture's own

  [[nodiscard]] bool is_plain() const { return std::holds_alternative<PlainInterval>(gains); }
  friend bool operator==(const ExposureRequest&, const ExposureRequest&) = default;
};

// The functions for a capture of this timeline, normalized and as bright as asked for: those that the mask uses.
// Throws UsageError where a plain interval lies outside the capture or is too short for its shutter, InputError
// where a function cannot be normalized.
[[nodiscard]] FunctionSet functions_of(const ExposureRequest& request, const Timeline& timeline);
// The same where the interval is known in nanoseconds, whatever was stated; functions have their time 0 at its
// start, whatever its end.
[[nodiscard]] FunctionSet functions_of(const ExposureRequest& request, const Exposure& interval,
                                       const Timeline& timeline);

// When the light of functions is gathered at the latest, counted from their time 0.
[[nodiscard]] std::int64_t functions_end_ns(const ExposureRequest& request);

// The mask for a picture of this shape: one function everywhere where none was stated.
[[nodiscard]] Mask mask_of(const ExposureRequest& request, const Shape& shape);

[[nodiscard]] PlanOptions plan_options_of(const ExposureRequest& request);

}  // namespace nutik
