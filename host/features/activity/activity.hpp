// When a capture changes, and where: what is asked, and what came of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "capture/timeline.hpp"
#include "imev/activity.hpp"
#include "imev/capture_source.hpp"
#include "session/session.hpp"
#include "system/interruption.hpp"
#include "system/shared.hpp"

namespace nutik {

struct ActivityRequest {
  // Only pixels of this mask count: those with the tag, or with any but 0. None: all pixels. A mask, or the name of an
  // input, as input_bytes.hpp has it.
  std::variant<std::monostate, std::string, Shared<Mask>> mask;
  std::optional<std::uint8_t> tag;
  bool each_tag = false;  // all pixels count, and those with each tag of the mask for themselves, too
  std::uint32_t ignored_codes = 0;  // changes of no more are none
  // Else samples at which a codec drew its picture anew count as those beside them.
  bool counts_redrawn = false;
};

// What the pixels with a tag do.
struct TagActivity {
  std::uint8_t tag = 0;
  std::uint64_t pixel_count = 0;
  bool is_still = false;                   // nothing changes
  std::optional<ActivityMoments> moments;  // none, either, of a capture that is too short
};

struct MeasuredActivity {
  Timeline timeline;
  Activity activity;
  std::vector<std::uint64_t> redrawn;  // samples that do not count
  std::optional<ActivityMoments> moments;
  std::vector<TagActivity> tags = {};  // by increasing tag, where each was asked for

  [[nodiscard]] bool is_still() const { return changes() == 0; }
  [[nodiscard]] std::uint64_t changes() const;  // of all pixels, at all samples
  // As shares of the pixels that count: of one sample; of all that has a sample before it, on average.
  [[nodiscard]] double changed_share(std::uint64_t sample) const;
  [[nodiscard]] double mean_share() const;
  // The quietest stretch, or the busiest, of all pixels or of those with a tag. All of the capture is quiet if nothing
  // changes. Throws InputError that calls the capture by its name.
  [[nodiscard]] SampleRange moment(const std::string& name, bool quietest) const;
  [[nodiscard]] SampleRange moment(const std::string& name, bool quietest, const TagActivity& of) const;
  [[nodiscard]] bool is_redrawn(std::uint64_t sample) const;
  [[nodiscard]] std::vector<Note> notes() const;
  // A line for each sample: sample,start_ns,end_ns,changed_pixels,changed_share,redrawn.
  [[nodiscard]] std::string table() const;
};

// Reads all of the capture; `progress` counts samples. Throws InputError where the mask does not fit the capture or
// no pixel counts.
[[nodiscard]] MeasuredActivity measure_activity(CaptureSource& capture, const ActivityRequest& request,
                                                const ReportedProgress& progress = {});
// Measures a session's capture within the session's memory: throws MemoryTooLittle, too.
[[nodiscard]] MeasuredActivity measure_activity(Session& session, const ActivityRequest& request,
                                                const ReportedProgress& progress = {});

}  // namespace nutik
