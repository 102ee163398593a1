#include <algorithm>

#include "app/commands/commands.hpp"
#include "app/commands/opened_session.hpp"
#include "app/output/console.hpp"
#include "app/output/ending.hpp"
#include "app/output/exposure_report.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/shared_warnings.hpp"
#include "app/output/stopwatch.hpp"
#include "app/output/video_output.hpp"
#include "app/requests/computing_words.hpp"
#include "app/requests/exposure_words.hpp"
#include "session/format.hpp"
#include "session/pictures.hpp"
#include "session/size_text.hpp"
#include "session/time_text.hpp"
#include "session/videos.hpp"
#include "system/interruption.hpp"

namespace nutik::app {
namespace {

std::filesystem::path usual_name(const std::string& input, Rational rate) {
  std::string text = rate.text();
  std::replace(text.begin(), text.end(), '/', '_');
  return format("{}-{}fps.mp4", sequence_name(input), text);
}

}  // namespace

int run_video(const Options& options) {
  const Stopwatch stopwatch;
  const auto stated = stated_output(options.output, options.operands, "video");
  const FramesRequest request = frames_request(options);
  const std::string& input = options.operands.front();
  const VideoOutput output(options, stated.value_or(usual_name(input, request.rate)), request.rate);
  const std::vector<std::string> inputs = input_files(options);
  output.check(0, inputs);  // a container's name, before the clip is read

  const std::shared_ptr<Devices> devices = make_devices(options);
  devices->start();
  Session session = open_session(input, options, devices);
  const CaptureFormat& capture = session.format();
  const Frames frames = frames_of(request, session.timeline());
  if (!frames.warning.empty()) print_warning(frames.warning);
  const PlanOptions plan_options = plan_options_of(request.exposure);
  const Mask mask = mask_of(request.exposure, capture.shape);
  const OutputFormat frame_format = output.frame_format(capture);
  output.check(frames.count, inputs);

  const Transfer transfer = plan_options.transfer.value_or(capture.transfer);
  FrameQueue queue([&] { return output.open(capture.shape, frame_format, transfer); });
  SharedWarnings warnings;
  ExposureTally tally;
  std::optional<Interrupted> interruption;
  std::uint64_t exposed_frames = 0;
  {
    Progress progress("exposing", frames.count, options.quiet);
    try {
      for (; exposed_frames < frames.count; ++exposed_frames) {
        check_interruption();
        progress.show(exposed_frames);
        const FunctionSet functions =
            functions_of(request.exposure, frames.times.exposure(exposed_frames), session.timeline());
        ExposedPicture exposed = session.render(functions, mask, plan_options, frame_format);
        tally.add(exposed);
        warnings.add(format("frame {}", exposed_frames), exposure_warnings(exposed));
        if (!queue.push(std::move(exposed.picture))) break;
      }
    } catch (const Interrupted& caught) {
      if (exposed_frames == 0) throw;
      interruption = caught;
      clear_interruption();  // what was exposed is still to be written
    }
    queue.finish();
  }
  warnings.print();
  if (interruption) {
    print_note(
        format("{}: {} of {} frames were written", output.path().string(), exposed_frames, frames.count));
    throw *interruption;
  }
  if (options.json) {
    Json json{{"video", output.path().string()}, {"kind", output.kind()}};
    add_shape(json, capture.shape);
    json["frames"] = frames.count;
    json["frames_a_second"] = request.rate.text();
    json["start_ns"] = frames.times.start_ns(0);
    json["end_ns"] = frames.times.end_ns(frames.count - 1);
    add_saturation(json, tally.saturation(), frame_format.type);
    add_rendering(json, session, tally, stopwatch);
    print_json(json);
    return 0;
  }
  if (ended_quietly(options, output.path())) return 0;

  const FrameTimes& times = frames.times;
  print_line(format("{}: {}, {} ({}), from {} to {} of the capture, {}{}, {:.2f} s on {}",
                    output.path().string(), shape_text(capture.shape), counted(frames.count, "frame"),
                    request.text(), duration_text(times.start_ns(0)),
                    duration_text(times.end_ns(frames.count - 1)), output.kind(),
                    saturation_text(tally.saturation(), frame_format.type), stopwatch.seconds(),
                    devices->renderer().name()));
  std::vector<std::string> notes;
  for (const std::string& note : queue.notes()) notes.push_back(format("note: {}", note));
  for (std::string& line : source_lines(session)) notes.push_back(std::move(line));
  print_details(options, tally, notes);
  return 0;
}

}  // namespace nutik::app
