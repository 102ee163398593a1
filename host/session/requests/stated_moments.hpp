// Stated times on a capture's timeline: moments, pictures, intervals. `37f` counts the pictures that were filmed
// (Timeline::pictures()), whatever samples were made between them.
#pragma once

#include <cstdint>
#include <string_view>

#include "capture/frame_times.hpp"
#include "capture/stated_time.hpp"
#include "capture/timeline.hpp"

namespace nutik {

// An interval's ends, each rounded half up once from its exact value. `3f` from `37f`: from the start of picture 37's
// exposure to the end of picture 39's; after a start in seconds, three periods. Throws UsageError if it is not longer
// than nothing or a picture is not there.
[[nodiscard]] Exposure plain_interval(const StatedTime& start, const StatedTime& length,
                                      const Timeline& timeline);
// The same from a moment, which is no picture's: lengths in pictures are periods.
[[nodiscard]] Exposure plain_interval(const ExactTime& start, const StatedTime& length,
                                      const Timeline& timeline);

// How long `count` periods are from the picture at a time, within the capture. Throws UsageError where it ends before.
[[nodiscard]] ExactTime periods_from(std::int64_t time_ns, std::int64_t count, const Timeline& timeline);

// The sample at a time: that of `37f`, or the last whose exposure begins no later than the time. Throws UsageError
// naming `what` where the time lies outside the capture.
[[nodiscard]] std::uint64_t sample_at(const StatedTime& time, std::string_view what,
                                      const Timeline& timeline);
// The last sample whose exposure begins no later than that, within the capture.
[[nodiscard]] std::uint64_t sample_at(std::int64_t time_ns, const Timeline& timeline);
// What states a sample: `37f`, or its start where it was made.
[[nodiscard]] StatedTime stated_sample(std::uint64_t sample, const Timeline& timeline);

// A moment on a timeline, exactly: `0.4s`, or `37f` for the start of picture 37 (as many as there are: the
// capture's end). Throws UsageError naming `what`.
[[nodiscard]] ExactTime exact_time(const StatedTime& time, std::string_view what, const Timeline& timeline);
// A moment on a timeline; that of a picture is the start of its exposure.
[[nodiscard]] std::int64_t moment_ns(const StatedTime& time, const Timeline& timeline);

// The time that lies as far behind the start of a sample as `time_ns` behind the start of its own, `steps` samples
// later or earlier; beyond the capture samples go on at its mean rate.
[[nodiscard]] std::int64_t samples_later(std::int64_t time_ns, std::int64_t steps, const Timeline& timeline);

}  // namespace nutik
