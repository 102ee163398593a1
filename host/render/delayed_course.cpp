#include "render/delayed_course.hpp"

#include <algorithm>
#include <optional>

#include "capture/format.hpp"
#include "capture/seconds_text.hpp"
#include "exposure/gain_function.hpp"

namespace nutik {

DelayedCourse::DelayedCourse(std::uint8_t tag, const FunctionSet& functions, std::int64_t duration_ns)
    : tag_(tag),
      is_mapped_(functions.contains(tag)),
      function_(is_mapped_ ? functions.at(tag) : GainFunction({{0, 0.0}})),
      summary_(summarize_course(function_, duration_ns)),
      duration_ns_(duration_ns) {}

void DelayedCourse::count(const MaskRegion& region, const GainSummary& delayed) {
  pixels_ += region.pixel_count;
  if (delayed.live.empty()) {
    dark_pixels_ += region.pixel_count;
    return;
  }
  if (delayed.reaches_before_capture) before_pixels_ += region.pixel_count;
  if (delayed.reaches_after_capture) after_pixels_ += region.pixel_count;
}

void DelayedCourse::warn(std::vector<std::string>& warnings, const std::string& name) const {
  const std::string function = name.empty() ? format("M{}", tag_) : name;
  const std::string end = seconds_text(duration_ns_);
  // What holds of several functions is said once.
  const auto add = [&](const std::string& sentence) {
    const std::string end_of_line = ": " + sentence;
    const auto said = std::find_if(warnings.begin(), warnings.end(), [&](const std::string& warning) {
      return warning.ends_with(end_of_line);
    });
    if (said == warnings.end()) {
      warnings.push_back(function + end_of_line);
    } else {
      said->insert(said->size() - end_of_line.size(), ", " + function);
    }
  };
  if (summary_.support_ns == 0) {
    if (is_mapped_) add("the function is zero everywhere; its pixels are 0");
    return;
  }
  if (dark_pixels_ > 0) {
    add(format(
        "for {} of {} pixels the delay moves the whole function outside of the capture (0 … {}); they are 0",
        dark_pixels_, pixels_, end));
  }
  const auto add_part = [&](std::uint64_t pixels, const std::string& where) {
    if (pixels == 0) return;
    add(
        format("for {} of {} pixels the delay moves a part of the function {}; nothing is added there, though "
               "D counts it, so they are darker",
               pixels, pixels_, where));
  };
  add_part(before_pixels_, "before the capture's start");
  add_part(after_pixels_, "behind the capture's end at " + end);
  const auto add_held = [&](double gain, const char* which, const char* end_of_capture) {
    if (gain == 0.0) return;
    add(format("its {} gain is not 0 and is held to the capture's {}, so a delay makes the time longer or "
               "shorter for which pixels are exposed, and them brighter or darker; put a gain of 0 beside it "
               "if it should not",
               which, end_of_capture));
  };
  add_held(function_.first_gain(), "first", "start");
  add_held(function_.last_gain(), "last", "end");
}

std::vector<std::string> delay_warnings(const MaskMap& map, const FunctionSet& functions,
                                        std::int64_t duration_ns) {
  std::vector<std::string> warnings;
  std::optional<DelayedCourse> course;
  for (const MaskRegion& region : map.regions) {
    if (!course || course->tag() != region.tag) {
      if (course) course->warn(warnings, {});
      course.emplace(region.tag, functions, duration_ns);
    }
    course->count(region, summarize(course->function().shifted(region.delay_ns), duration_ns));
  }
  if (course) course->warn(warnings, {});
  return warnings;
}

}  // namespace nutik
