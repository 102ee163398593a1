// A contact sheet, as it is asked for: exposures at equal distances from one time on.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "capture/error.hpp"
#include "session/requests/stated_time.hpp"

namespace nutik {

struct ContactRequest {
  StatedTime start;
  std::optional<StatedTime> every;   // longer than nothing; pictures are whole ones. None: so that 24 fit
  std::optional<StatedTime> length;  // of each. None: what the camera exposed at that time

  friend bool operator==(const ContactRequest&, const ContactRequest&) = default;
};

// Sample by sample where pictures are counted or nothing is stated, else at exact multiples of a time. An exposure
// may go on behind the capture's end. Throws UsageError where they are more than a sheet has room for, or the start lies outside.
[[nodiscard]] std::vector<Exposure> exposures_of(const ContactRequest& request, const Timeline& timeline);

// `0.4 s   12f` for each exposure: times in one unit, with the decimals that tell neighbours apart, and the picture
// of the clip.
[[nodiscard]] std::vector<std::string> labels_of(const std::vector<Exposure>& exposures,
                                                 const Timeline& timeline);

}  // namespace nutik
