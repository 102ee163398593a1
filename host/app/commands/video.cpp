#include <algorithm>

#include "app/commands/commands.hpp"
#include "app/commands/opened_session.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "app/requests/requests.hpp"
#include "session/format.hpp"
#include "session/size_text.hpp"
#include "session/time_text.hpp"
#include "session/video_output.hpp"
#include "session/videos.hpp"
#include "system/interruption.hpp"

namespace nutik::app {

int run_video(const Options& options) {
  ExposureTally tally;
  static_cast<void>(stated_output(options, "video"));  // files before what is asked of them
  const FramesRequest request = frames_request(options);
  std::string rate = request.rate.text();
  std::ranges::replace(rate, '/', '_');
  const VideoOutput output(output_name(options, "video", format("-{}fps.mp4", rate)), request.rate,
                           options.video_codec, output_request(options));
  const std::vector<std::string> inputs = input_files(options);
  output.check(0, inputs);  // a container's name, before the clip is read

  Session session = open_session(
      options, {.besides = video_needs(output.encoder_frames(), [&](const CaptureFormat& format) {
                  return output.frame_format(format).type;
                })});
  CaptureFormat capture = session.format();
  const Frames frames = frames_of(request, session.timeline());
  if (!frames.warning.empty()) print_warning(frames.warning);
  const PlanOptions plan = plan_options_of(request.exposure);
  const Mask mask = mask_of(request.exposure, capture.shape);
  const OutputFormat frame_format = output.frame_format(capture);
  output.check(frames.count, inputs);

  PictureRecipe recipe(output.writes_stills() ? recipe_sources(options) : std::nullopt);
  capture.transfer = plan.transfer.value_or(capture.transfer);
  const TimeToEnd is_kept;  // the frames so far, whatever a frame takes
  FrameQueue queue([&] { return output.open(capture, frame_format); },
                   session.waiting_pictures(frame_format.type));
  std::optional<Interrupted> interruption;
  std::uint64_t exposed_frames = 0;
  {
    WarningsAtEnd warnings;
    Progress progress("exposing", frames.count, options.quiet);
    try {
      for (; exposed_frames < frames.count; ++exposed_frames) {
        check_interruption();
        progress.show(exposed_frames);
        const Exposure exposure = frames.times.exposure(exposed_frames);
        const FunctionSet functions = functions_of(request.exposure, exposure, session.timeline());
        ExposedPicture exposed = session.render(functions, mask, plan, frame_format);
        tally.add(exposed);
        warnings.add(format("frame {}", exposed_frames), exposure_warnings(exposed));
        if (!queue.push(std::move(exposed.picture),
                        recipe.text(tally.precision(), own_recipe(exposure, request.exposure.is_plain()))))
          break;
      }
    } catch (const Interrupted& caught) {
      if (exposed_frames == 0) throw;
      interruption = caught;
      clear_interruption();  // what was exposed is still to be written
    }
    queue.finish();
  }
  const std::string name = output.path().string();
  if (interruption) {
    print_note(format("{}: {} of {} frames were written", name, exposed_frames, frames.count));
    throw *interruption;
  }

  const std::int64_t start_ns = frames.times.start_ns(0), end_ns = frames.times.end_ns(frames.count - 1);
  Answer answer{{{"video", name}, {"kind", output.kind()}}};
  answer.json.update(shape_json(capture.shape));
  answer.json.update({{"frames", frames.count},
                      {"frames_a_second", request.rate.text()},
                      {"start_ns", start_ns},
                      {"end_ns", end_ns}});
  answer.line = format("{}: {}, {} ({}), from {} to {} of the capture, {}", name, shape_text(capture.shape),
                       counted(frames.count, "frame"), request.text(), duration_text(start_ns),
                       duration_text(end_ns), output.kind() + codes_text(capture, frame_format));
  tally.end(answer, session, options.verbose);
  for (const std::string& note : queue.notes()) answer.notes.push_back("note: " + note);
  std::ranges::move(source_lines(session), std::back_inserter(answer.notes));
  return tell(options, output.path(), answer);
}

}  // namespace nutik::app
