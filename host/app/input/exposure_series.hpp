// When the exposures of a series start: --start, --every and --count on a timeline.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/input/exposure_request.hpp"

namespace nutik::app {

class ExposureSeries {
 public:
  // Throws UsageError where --every or --count make no sense.
  static ExposureSeries from(const Options& options);

  // The start of each exposure, exactly start + k · every, rounded once from its own exact value: no drift.
  // Counted in pictures where both are, else in nanoseconds. Without --count as many as end within the
  // capture. Throws UsageError where there is none, or where one of --count starts behind the capture's end.
  [[nodiscard]] std::vector<TimeText> starts(const ExposureRequest& request, const Timeline& timeline) const;

  [[nodiscard]] const std::string& every_text() const { return every_text_; }

 private:
  [[nodiscard]] TimeText start(const TimeText& first, std::uint64_t k, const Timeline& timeline) const;
  // Whether an exposure from there on lies within the capture, or starts there.
  static bool ends_within(const ExposureRequest& request, const TimeText& start, const Timeline& timeline);
  static bool starts_within(const TimeText& start, const Timeline& timeline);

  TimeText every_;
  std::string every_text_;
  std::optional<std::uint64_t> count_;
};

}  // namespace nutik::app
