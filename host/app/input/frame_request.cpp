#include "app/input/frame_request.hpp"

#include <algorithm>

#include "app/output/console.hpp"
#include "app/text/time_text.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik::app {
namespace {

constexpr const char* kFilmRate = "24";
constexpr const char* kFilmAngle = "180";

}  // namespace

FrameRequest FrameRequest::from(const Options& options) {
  if (options.functions && options.out_angle) {
    throw UsageError(
        "--out-angle describes plain exposures; with -k the functions say how each frame is exposed, from "
        "its start on. Use one");
  }
  return {options, ExposureRequest::for_frames(options)};
}

FrameRequest::FrameRequest(const Options& options, ExposureRequest exposure)
    : exposure_(std::move(exposure)),
      rate_(Rational::parse(options.out_fps.value_or(kFilmRate), "frame rate of the video")),
      speed_(Rational::parse(options.speed.value_or("1"), "speed")),
      angle_(Rational::parse(options.out_angle.value_or(kFilmAngle), "shutter angle of the video")),
      from_(options.from.value_or("0s")),
      to_(options.to) {
  // Before anything is opened.
  TimeText::parse(from_, "the video's start");
  if (to_) TimeText::parse(*to_, "the video's end");
  static_cast<void>(FrameTimes({}, rate_, speed_, angle_));
}

Frames FrameRequest::frames(const Timeline& timeline) const {
  const FrameTimes times(exact_time(from_, "the video's start", timeline), rate_, speed_, angle_);
  const std::int64_t start_ns = times.start_ns(0);
  std::int64_t end_ns = timeline.duration_ns();
  if (to_) {
    const ExactTime to = exact_time(*to_, "the video's end", timeline);
    const std::int64_t to_ns = round_half_up(to.numerator, to.denominator);
    if (to_ns > end_ns) {
      print_warning(
          format("the video's end {} lies after the capture's end at {}; the video ends with the capture",
                 *to_, duration_text(end_ns)));
    }
    end_ns = std::min(end_ns, to_ns);
  }
  if (start_ns < 0 || start_ns >= timeline.duration_ns()) {
    throw UsageError(format("the video's start {} lies outside the capture, which lasts {}", from_,
                            duration_text(timeline.duration_ns())));
  }
  const std::int64_t length_ns =
      exposure_.is_plain() ? times.end_ns(0) - start_ns : exposure_.functions_end_ns();
  const std::uint64_t count = exposure_.is_plain()
                                  ? times.count_ending_by(end_ns)
                                  // A frame that starts at the very end sees nothing.
                                  : times.count_starting_by(end_ns - std::max<std::int64_t>(length_ns, 1));
  if (count == 0) {
    throw UsageError(
        format("no frame fits: each is exposed for {}, and between the video's start and end are {}",
               duration_text(length_ns), duration_text(std::max<std::int64_t>(end_ns - start_ns, 0))));
  }
  return {times, count};
}

std::string FrameRequest::text() const {
  std::string text = format("{} frames a second", rate_.text());
  if (exposure_.is_plain()) text += format(", {} degrees", angle_.text());
  if (speed_ != Rational{1, 1}) text += format(", speed {}", speed_.text());
  return text;
}

}  // namespace nutik::app
