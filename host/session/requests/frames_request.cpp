#include "session/requests/frames_request.hpp"

#include <algorithm>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "session/text/time_text.hpp"

namespace nutik {

std::string FramesRequest::text() const {
  std::string text = format("{} frames a second", rate.text());
  if (exposure.is_plain()) text += format(", {} degrees", angle.text());
  if (speed != Rational{1, 1}) text += format(", speed {}", speed.text());
  return text;
}

Frames frames_of(const FramesRequest& request, const Timeline& timeline) {
  Frames frames{FrameTimes(exact_time(request.from, "the video's start", timeline), request.rate,
                           request.speed, request.angle),
                0,
                {}};
  const std::int64_t start_ns = frames.times.start_ns(0);
  std::int64_t end_ns = timeline.duration_ns();
  if (request.to) {
    const ExactTime to = exact_time(*request.to, "the video's end", timeline);
    const std::int64_t to_ns = round_half_up(to.numerator, to.denominator);
    if (to_ns > end_ns) {
      frames.warning =
          format("the video's end {} lies after the capture's end at {}; the video ends with the capture",
                 request.to->text(), duration_text(end_ns));
    }
    end_ns = std::min(end_ns, to_ns);
  }
  if (start_ns < 0 || start_ns >= timeline.duration_ns()) {
    throw UsageError(format("the video's start {} lies outside the capture, which lasts {}",
                            request.from.text(), duration_text(timeline.duration_ns())));
  }
  const bool is_plain = request.exposure.is_plain();
  const std::int64_t length_ns =
      is_plain ? frames.times.end_ns(0) - start_ns : functions_end_ns(request.exposure);
  frames.count = is_plain ? frames.times.count_ending_by(end_ns)
                          // A frame that starts at the very end sees nothing.
                          : frames.times.count_starting_by(end_ns - std::max<std::int64_t>(length_ns, 1));
  if (frames.count == 0) {
    throw UsageError(
        format("no frame fits: each is exposed for {}, and between the video's start and end are {}",
               duration_text(length_ns), duration_text(std::max<std::int64_t>(end_ns - start_ns, 0))));
  }
  return frames;
}

NeedsOfFormat video_needs(std::uint32_t encoder_frames,
                          const std::function<ValueType(const CaptureFormat&)>& type_of) {
  return [encoder_frames, type_of](const CaptureFormat& capture) {
    const std::uint64_t bytes = capture.shape.value_count() * value_bytes(type_of(capture));
    const std::uint64_t encoded = capture.shape.pixel_count() * 3 / 2;
    return MemoryNeeds{{"frames that wait", (waiting_pictures(bytes) + 3) * bytes},
                       {"frames within the encoder", encoder_frames * encoded}};
  };
}

}  // namespace nutik
