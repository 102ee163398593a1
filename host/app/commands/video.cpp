#include <algorithm>

#include "app/commands/commands.hpp"
#include "app/input/exposer.hpp"
#include "app/input/opened_capture.hpp"
#include "app/output/console.hpp"
#include "app/output/ending.hpp"
#include "app/output/exposure_report.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/shared_warnings.hpp"
#include "app/output/stopwatch.hpp"
#include "app/output/video_output.hpp"
#include "app/requests/exposure_words.hpp"
#include "capture/format.hpp"
#include "media/frame_queue.hpp"
#include "media/still_sequence.hpp"
#include "session/size_text.hpp"
#include "session/time_text.hpp"
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

  Exposer exposer(options);
  OpenedCapture capture(input, options);
  tik::Reader& reader = capture.reader();
  exposer.keep_resident(reader);
  const Frames frames = frames_of(request, reader.timeline());
  if (!frames.warning.empty()) print_warning(frames.warning);
  const PlanOptions plan_options = plan_options_of(request.exposure);
  const Mask mask = mask_of(request.exposure, reader.format().shape);
  const OutputFormat frame_format = output.frame_format(reader.format());
  output.check(frames.count, inputs);

  const Transfer transfer = plan_options.transfer.value_or(reader.format().transfer);
  FrameQueue queue([&] { return output.open(reader.format().shape, frame_format, transfer); });
  SharedWarnings warnings;
  Saturation saturation;  // of all frames together
  std::optional<Interrupted> interruption;
  std::uint64_t exposed_frames = 0;
  {
    Progress progress("exposing", frames.count, options.quiet);
    try {
      for (; exposed_frames < frames.count; ++exposed_frames) {
        check_interruption();
        progress.show(exposed_frames);
        const FunctionSet functions =
            functions_of(request.exposure, frames.times.exposure(exposed_frames), reader.timeline());
        Exposed exposed = exposer.expose(reader, functions, mask, plan_options, frame_format);
        saturation += exposed.saturation;
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
    add_shape(json, reader.format().shape);
    json["frames"] = frames.count;
    json["frames_a_second"] = request.rate.text();
    json["start_ns"] = frames.times.start_ns(0);
    json["end_ns"] = frames.times.end_ns(frames.count - 1);
    add_saturation(json, saturation, frame_format.type);
    add_rendering(json, exposer, stopwatch);
    print_json(json);
    return 0;
  }
  if (ended_quietly(options, output.path())) return 0;

  const FrameTimes& times = frames.times;
  print_line(
      format("{}: {}, {} ({}), from {} to {} of the capture, {}{}, {:.2f} s on {}", output.path().string(),
             shape_text(reader.format().shape), counted(frames.count, "frame"), request.text(),
             duration_text(times.start_ns(0)), duration_text(times.end_ns(frames.count - 1)), output.kind(),
             saturation_text(saturation, frame_format.type), stopwatch.seconds(), exposer.renderer_name()));
  std::vector<std::string> notes;
  for (const std::string& note : queue.notes()) notes.push_back(format("note: {}", note));
  notes.insert(notes.end(), capture.notes().begin(), capture.notes().end());
  print_details(options, exposer, notes);
  return 0;
}

}  // namespace nutik::app
