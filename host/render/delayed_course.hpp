// What the delays of a time map make of one function: where its pixels are exposed with it, and what of that lies
// outside of the capture.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/render_plan.hpp"

namespace nutik {

class DelayedCourse {
 public:
  // A mask value without a function is exposed to 0.
  DelayedCourse(std::uint8_t tag, const FunctionSet& functions, std::int64_t duration_ns);

  [[nodiscard]] std::uint8_t tag() const { return tag_; }
  [[nodiscard]] const GainFunction& function() const { return function_; }
  // D, whatever the delay: that of the function's whole course.
  [[nodiscard]] std::int64_t support_ns() const { return summary_.support_ns; }

  // The function after a region's delay.
  void count(const MaskRegion& region, const GainSummary& delayed);
  // Whole sentences, with numbers of pixels; the function is called `name` if that is not empty.
  void warn(std::vector<std::string>& warnings, const std::string& name) const;

 private:
  std::uint8_t tag_;
  bool is_mapped_;
  GainFunction function_;
  GainSummary summary_;
  std::int64_t duration_ns_;
  std::uint64_t pixels_ = 0;
  std::uint64_t dark_pixels_ = 0;    // nothing of the function lies within the capture
  std::uint64_t before_pixels_ = 0;  // some of it lies before, and some within
  std::uint64_t after_pixels_ = 0;
};

// What of functions delays move outside of a capture of this length, as a plan warns of it.
[[nodiscard]] std::vector<std::string> delay_warnings(const MaskMap& map, const FunctionSet& functions,
                                                      std::int64_t duration_ns);

}  // namespace nutik
