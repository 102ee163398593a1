#include <algorithm>

#include "app/commands/commands.hpp"
#include "app/commands/opened_session.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "app/requests/requests.hpp"
#include "session/below/format.hpp"
#include "session/making/video_making.hpp"
#include "session/text/size_text.hpp"
#include "session/text/time_text.hpp"

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
  const Shape shape = session.format().shape;
  const Frames frames = frames_of(request, session.timeline());
  if (!frames.warning.empty()) print_warning(frames.warning);
  output.check(frames.count, inputs);
  PictureRecipe recipe(output.writes_stills() ? recipe_sources(options) : std::nullopt);
  std::string codes;  // how the frames differ from the capture
  const MadeVideo made = [&] {
    WarningsAtEnd warnings;
    return make_video(session, request, frames, output, progress_bar("exposing", options.quiet),
                      [&](std::uint64_t frame, const Exposure& exposure, const ExposedPicture& exposed) {
                        tally.add(exposed);
                        codes = codes_text(exposed.figures.capture, exposed.output);
                        warnings.add(format("frame {}", frame), exposure_warnings(exposed));
                        return recipe.text(tally.precision(),
                                           own_recipe(exposure, request.exposure.is_plain()));
                      });
  }();
  const std::string name = output.path().string();
  if (made.interruption) {
    print_note(format("{}: {} of {} frames were written", name, made.frames, frames.count));
    throw *made.interruption;
  }

  const std::int64_t start_ns = frames.times.start_ns(0), end_ns = frames.times.end_ns(frames.count - 1);
  Answer answer{{{"video", name}, {"kind", output.kind()}}};
  answer.json.update(shape_json(shape));
  answer.json.update({{"frames", frames.count},
                      {"frames_a_second", request.rate.text()},
                      {"start_ns", start_ns},
                      {"end_ns", end_ns}});
  answer.line = format("{}: {}, {} ({}), from {} to {} of the capture, {}", name, shape_text(shape),
                       counted(frames.count, "frame"), request.text(), duration_text(start_ns),
                       duration_text(end_ns), output.kind() + codes);
  tally.end(answer, session, options.verbose);
  answer.tell_source(session);
  std::ranges::copy(made.notes, std::back_inserter(answer.notes));
  return tell(options, output.path(), answer);
}

}  // namespace nutik::app
