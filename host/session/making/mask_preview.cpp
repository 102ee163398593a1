#include "session/making/mask_preview.hpp"

#include <algorithm>

#include "session/requests/output_request.hpp"

namespace nutik {

ExposedPicture backdrop_of(Session& session, const BackdropTime& time) {
  const Timeline& timeline = session.timeline();
  Exposure interval{0, timeline.duration_ns()};
  if (time.length) {
    interval = plain_interval(time.start.value_or(StatedTime{}), *time.length, timeline);
  } else if (time.start) {
    const std::uint64_t sample = sample_at(*time.start, "start", timeline);
    interval = {timeline.start_ns(sample), timeline.end_ns(sample)};
  }
  const CaptureFormat& format = session.format();
  FunctionSet functions;
  functions.emplace(0, GainFunction::boxcar(interval.start_ns, interval.end_ns));
  PlanOptions plan;
  plan.function_name = "the preview's exposure";
  return session.render(functions, Mask::uniform(format.shape.width, format.shape.height, 0), plan,
                        output_format({}, format));
}

Picture backdrop_of(const MaskRequest& request, const Mask& mask) {
  for (const MaskStep& step : request.steps) {
    for (const NamedPicture* picture : step.pictures()) return *picture->picture;
  }
  Picture grey({mask.width, mask.height, 1}, ValueType::code8, 255);
  std::fill(grey.bytes.begin(), grey.bytes.end(), std::byte{200});
  return grey;
}

}  // namespace nutik
