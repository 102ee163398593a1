#include "app/commands/commands.hpp"
#include "app/output/console.hpp"
#include "app/output/ending.hpp"
#include "app/output/json.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/stopwatch.hpp"
#include "app/requests/source_words.hpp"
#include "app/text/shell_text.hpp"
#include "app/text/timing_text.hpp"
#include "session/encoding.hpp"
#include "session/error.hpp"
#include "session/format.hpp"
#include "session/pictures.hpp"
#include "session/size_text.hpp"

namespace nutik::app {
namespace {

std::filesystem::path output_path(const Options& options) {
  const auto stated = stated_output(options.output, options.operands, "encode");
  return stated ? *stated : std::filesystem::path(sequence_name(options.operands.front()) + ".tik");
}

}  // namespace

int run_encode(const Options& options) {
  const Stopwatch stopwatch;
  const std::filesystem::path output = output_path(options);
  const std::string& input = options.operands.front();
  const SourceRequest source = clip_request(options, input);
  const tik::Codec codec = tik::Codec::parse(options.codec.value_or("zstd"));
  if (is_tik(input) && std::filesystem::exists(input)) {
    throw UsageError(
        format("{} is a capture already; to expose a picture from it: nutik-cl --start 0s "
               "--exposure 10ms {} picture.png",
               input, shell_word(input)));
  }
  check_output(output, OutputKind::tik, input_files(options));

  const Encoded encoded =
      encode(source, {output, codec}, memory_budget(options), progress_bar("encoding", options.quiet));
  for (const std::string& warning : encoded.warnings) print_warning(warning);
  const CaptureFormat& capture = encoded.capture;
  const Timeline& timeline = encoded.timeline;
  const std::uint64_t raw_bytes = capture.sample_bytes() * timeline.sample_count();
  if (options.json) {
    Json json{{"capture", output.string()}};
    add_shape(json, capture.shape);
    json["samples"] = timeline.sample_count();
    json["samples_a_second"] = timeline.rate().text();
    json["shutter_angle_degrees"] = timeline.shutter_angle().text();
    json["duration_ns"] = timeline.duration_ns();
    json["file_bytes"] = encoded.file_bytes;
    json["raw_bytes"] = raw_bytes;
    json["seconds"] = stopwatch.seconds();
    print_json(json);
    return 0;
  }
  if (ended_quietly(options, output)) return 0;

  print_line(format("{}: {}, {}, {}, {} of {} raw, {:.2f} s", output.string(), shape_text(capture.shape),
                    counted(timeline.sample_count(), "sample"), timing_text(timeline, source),
                    bytes_text(encoded.file_bytes), bytes_text(raw_bytes), stopwatch.seconds()));
  for (const std::string& line : note_lines(encoded.notes, timeline, source)) print_note(line);
  return 0;
}

}  // namespace nutik::app
