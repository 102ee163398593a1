#include "app/input/frame_request.hpp"

#include <algorithm>

#include "app/text/time_text.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik::app {
namespace {

constexpr const char* kFilmRate = "24";
constexpr const char* kFilmAngle = "180";

// Until when after a frame's start one of the functions that the mask uses is not zero: to the control point
// after its last gain, or to its last control point where the last gain holds to the capture's end.
std::int64_t reach_ns(const FunctionSet& functions, const Mask& mask) {
  const auto pixels = mask.pixels_per_tag();
  std::int64_t reach = 0;
  for (const auto& [tag, function] : functions) {
    if (pixels[tag] == 0) continue;
    const auto points = function.points();
    const auto after_last = std::find_if(points.rbegin(), points.rend(), [](const ControlPoint& point) {
                              return point.gain != 0.0;
                            }).base();
    if (after_last == points.begin()) continue;  // zero everywhere
    reach = std::max(reach, (after_last == points.end() ? points.back() : *after_last).time_ns);
  }
  return reach;
}

}  // namespace

FunctionSet Frames::functions(std::uint64_t k) const {
  FunctionSet shifted;
  if (functions_.empty()) {
    const Exposure exposure = times_.exposure(k);
    shifted.emplace(std::uint8_t{0}, GainFunction::boxcar(exposure.start_ns, exposure.end_ns));
    return shifted;
  }
  const std::int64_t start_ns = times_.start_ns(k);
  for (const auto& [tag, function] : functions_) shifted.emplace(tag, function.shifted(start_ns));
  return shifted;
}

FrameRequest FrameRequest::from(const Options& options) {
  FrameRequest request;
  request.rate_ = Rational::parse(options.out_fps.value_or(kFilmRate), "frame rate of the video");
  request.angle_ = Rational::parse(options.out_angle.value_or(kFilmAngle), "shutter angle of the video");
  request.speed_ = Rational::parse(options.speed.value_or("1"), "speed");
  request.from_ = options.from.value_or("0s");
  request.to_ = options.to;
  // Before anything is opened.
  TimeText::parse(request.from_, "the video's start");
  if (request.to_) TimeText::parse(*request.to_, "the video's end");
  static_cast<void>(FrameTimes({}, request.rate_, request.speed_, request.angle_));
  if (options.functions) {
    if (options.out_angle) {
      throw UsageError(
          "--out-angle describes plain exposures; with -k the functions say how each frame is "
          "exposed, from its start on. Use one");
    }
    request.functions_ = ExposureRequest::from(options);
    request.plan_options_ = request.functions_->plan_options();
    return request;
  }
  if (options.mask) throw UsageError("a mask goes with gain functions: -k functions.fn");
  request.plan_options_ = ExposureRequest::plan_options_from(options);
  request.plan_options_.function_name = "the exposure";
  return request;
}

Frames FrameRequest::frames(const Timeline& timeline, const Shape& shape) const {
  const ExactTime from = exact_time(from_, "the video's start", timeline);
  const FrameTimes times(from, rate_, speed_, angle_);
  const ExactTime to =
      to_ ? exact_time(*to_, "the video's end", timeline) : ExactTime{timeline.duration_ns(), 1};
  const std::int64_t start_ns = times.start_ns(0);
  const std::int64_t end_ns = std::min(round_half_up(to.numerator, to.denominator), timeline.duration_ns());
  if (start_ns < 0 || start_ns >= timeline.duration_ns()) {
    throw UsageError(format("the video's start {} lies outside the capture, which lasts {}", from_,
                            duration_text(timeline.duration_ns())));
  }
  const auto check_any = [&](std::uint64_t count, std::int64_t length_ns) {
    if (count > 0) return;
    throw UsageError(
        format("no frame fits: each is exposed for {}, and between the video's start and end are {}",
               duration_text(length_ns), duration_text(std::max<std::int64_t>(end_ns - start_ns, 0))));
  };
  if (!functions_) {
    const std::uint64_t count = times.count_ending_by(end_ns);
    check_any(count, times.end_ns(0) - start_ns);
    return {times, count, {}, Mask::uniform(shape.width, shape.height, 0)};
  }
  FunctionSet functions = functions_->functions(timeline);
  Mask mask = functions_->mask(shape);
  const std::int64_t reach = reach_ns(functions, mask);
  // A frame that starts at the very end sees nothing.
  const std::uint64_t count = times.count_starting_by(end_ns - std::max<std::int64_t>(reach, 1));
  check_any(count, reach);
  return {times, count, std::move(functions), std::move(mask)};
}

std::string FrameRequest::text() const {
  std::string text = format("{} frames a second", rate_.text());
  if (!functions_) text += format(", {} degrees", angle_.text());
  if (speed_ != Rational{1, 1}) text += format(", speed {}", speed_.text());
  return text;
}

}  // namespace nutik::app
