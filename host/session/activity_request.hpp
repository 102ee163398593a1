// When a capture changes, and where: what is asked, and what came of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "capture/timeline.hpp"
#include "imev/activity.hpp"
#include "imev/activity_moments.hpp"
#include "imev/capture_source.hpp"
#include "session/reported_progress.hpp"

namespace nutik {

struct ActivityRequest {
  // Only pixels of this mask count: those with the tag, or with any but 0. None: all pixels.
  std::optional<std::string> mask;  // an input, as input_bytes.hpp has it
  std::optional<std::uint8_t> tag;
  std::uint32_t ignored_codes = 0;  // changes of no more are none
};

struct MeasuredActivity {
  Timeline timeline;
  Activity activity;
  std::optional<ActivityMoments> moments;

  [[nodiscard]] bool is_still() const { return changes() == 0; }
  [[nodiscard]] std::uint64_t changes() const;  // of all pixels, at all samples
  // As shares of the pixels that count: of one sample; of a stretch, and of all that has a sample before it, on
  // average.
  [[nodiscard]] double changed_share(std::uint64_t sample) const;
  [[nodiscard]] double mean_share(const ActivityStretch& stretch) const;
  [[nodiscard]] double mean_share() const;
  // A line for each sample: sample,start_ns,end_ns,changed_pixels,changed_share.
  [[nodiscard]] std::string table() const;
};

// Reads all of the capture; `progress` counts samples. Throws InputError where the mask does not fit the capture or
// no pixel counts.
[[nodiscard]] MeasuredActivity measure_activity(CaptureSource& capture, const ActivityRequest& request,
                                                const ReportedProgress& progress = {});

}  // namespace nutik
