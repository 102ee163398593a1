#include <utility>

#include "app/commands/camera_files.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "app/output/timing_text.hpp"
#include "app/requests/requests.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/schema/options.hpp"
#include "session/clips/encoding.hpp"
#include "session/text/number_text.hpp"
#include "session/text/shell_text.hpp"
#include "system/is_absent.hpp"

namespace nutik::app {

int run_encode(const Options& options) {
  const Stopwatch stopwatch;
  const std::filesystem::path output = output_name(options, "encode", ".tik");
  const std::string& input = options.operands.front();
  const SourceRequest source = clip_request(options, input);
  if (!is_absent(input) && is_tik(input)) {
    throw UsageError(
        format("{} is a capture already; to expose a picture from it: nutik-cl --start 0s "
               "--exposure 10ms {} picture.png",
               input, shell_word(input)));
  }
  check_output(output, OutputKind::tik, input_files(options), replacing(options));
  const CameraFiles camera_files(options, output, input_files(options));

  const EncodedCapture encoded =
      encode(source, {output, options.codec}, memory_budget(options), progress_bar("encoding", options.quiet, progress_lines(options)));
  print_warnings(encoded.warnings);
  const Shape& shape = encoded.capture.shape;
  const Timeline& timeline = encoded.timeline;
  const std::uint64_t raw_bytes = encoded.capture.sample_bytes() * timeline.sample_count();
  const double seconds = stopwatch.seconds();
  Answer answer{{{"capture", output.string()}}};
  answer.json.update(shape_json(shape));
  answer.json.update({{"samples", timeline.sample_count()},
                      {"samples_a_second", timeline.rate().text()},
                      {"shutter_angle_degrees", timeline.shutter_angle().text()},
                      {"duration_ns", timeline.duration_ns()},
                      {"file_bytes", encoded.file_bytes},
                      {"raw_bytes", raw_bytes},
                      {"seconds", seconds}});
  answer.line = format("{}: {}, {}, {}, {} of {} raw, {:.2f} s", output.string(), shape_text(shape),
                       counted(timeline.sample_count(), "sample"), timing_text(encoded.facts),
                       bytes_text(encoded.file_bytes), bytes_text(raw_bytes), seconds);
  answer.tell_source(encoded.facts, encoded.notes);
  answer.source.erase(answer.source.begin());  // of times, which the line above has
  answer.details = std::exchange(answer.source, {});
  if (encoded.camera) camera_files.write(**encoded.camera, timeline, input, answer);
  return tell(options, output, answer);
}

}  // namespace nutik::app
