// A series of exposures of one capture: the same again and again, each a step later.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "capture/error.hpp"
#include "session/requests/exposure_request.hpp"
#include "session/requests/frame_ranges.hpp"

namespace nutik {

struct SeriesRequest {
  // More pictures than a folder is pleasant with, and than anybody means.
  static constexpr std::uint32_t kMaxExposures = 1'000'000;

  StatedTime every;                    // longer than nothing; pictures are whole ones
  std::optional<std::uint64_t> count;  // none: as many as end within the capture
  std::optional<FrameRanges> numbers = {};  // of the exposures to make; none: all

  friend bool operator==(const SeriesRequest&, const SeriesRequest&) = default;
};

// The start of each exposure, exactly start + k · every: no drift, and what is added to it is rounded once with it.
// Counted in pictures where both are, else in time. Throws UsageError where one starts behind the capture's end,
// none ends within it, or more than kMaxExposures would and no count was stated.
[[nodiscard]] std::vector<StatedTime> starts_of(const SeriesRequest& series, const ExposureRequest& request,
                                                const Timeline& timeline);

}  // namespace nutik
