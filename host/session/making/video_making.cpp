#include "session/making/video_making.hpp"

#include <utility>

#include "media/frame_queue.hpp"

namespace nutik {

MadeVideo make_video(Session& session, const FramesRequest& request, const Frames& frames,
                     const VideoOutput& output, const ReportedProgress& progress,
                     const std::function<std::string(std::uint64_t frame, const Exposure& exposure,
                                                     const ExposedPicture& exposed)>& add) {
  CaptureFormat capture = session.format();
  const PlanOptions plan = plan_options_of(request.exposure, capture.shape);
  const Mask mask = mask_of(request.exposure, capture.shape);
  const OutputFormat frame_format = output.frame_format(capture);
  capture.transfer = plan.transfer.value_or(capture.transfer);

  MadeVideo made;
  const TimeToEnd is_kept;  // the frames so far, whatever a frame takes
  FrameQueue queue([&] { return output.open(capture, frame_format); },
                   session.waiting_pictures(frame_format.type));
  try {
    for (; made.frames < frames.count; ++made.frames) {
      check_interruption();
      if (progress) progress(made.frames, frames.count);
      const Exposure exposure = frames.times.exposure(made.frames);
      const FunctionSet functions = functions_of(request.exposure, exposure, session.timeline());
      ExposedPicture exposed = session.render(functions, mask, plan, frame_format);
      std::string text = add ? add(made.frames, exposure, exposed) : std::string();
      if (!queue.push(std::move(exposed.picture), std::move(text))) break;
    }
  } catch (const Interrupted& caught) {
    if (made.frames == 0) throw;
    made.interruption = caught;
    clear_interruption();  // what was exposed is still to be written
  }
  queue.finish();
  made.notes = queue.notes();
  return made;
}

}  // namespace nutik
