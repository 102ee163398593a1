#include "app/commands/commands.hpp"
#include "app/input/capture_input.hpp"
#include "app/input/encoding.hpp"
#include "app/output/console.hpp"
#include "app/output/ending.hpp"
#include "app/output/json.hpp"
#include "app/output/output_name.hpp"
#include "app/output/stopwatch.hpp"
#include "app/text/shell_text.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/still_sequence.hpp"
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
  const SourceOptions source_options = SourceOptions::from(options);
  const tik::Codec codec = tik::Codec::parse(options.codec.value_or("zstd"));
  if (is_tik(input) && std::filesystem::exists(input)) {
    throw UsageError(
        format("{} is a capture already; to expose a picture from it: nutik-cl --start 0s "
               "--exposure 10ms {} picture.png",
               input, shell_word(input)));
  }
  check_output(output, OutputKind::tik, input_files(options));

  SourceClip source = open_source(input, source_options);
  const std::uint64_t announced = source.clip->info().sample_count;
  const std::vector<std::string> notes = source.notes;
  Encoding encoding(std::move(source), source_options, codec, input, output);
  Progress progress("encoding", announced, options.quiet);
  const Timeline timeline = encoding.run(progress);
  if (options.json) {
    const CaptureFormat& written = encoding.source().capture;
    Json json{{"capture", output.string()}};
    add_shape(json, written.shape);
    json["samples"] = timeline.sample_count();
    json["samples_a_second"] = timeline.rate().text();
    json["shutter_angle_degrees"] = timeline.shutter_angle().text();
    json["duration_ns"] = timeline.duration_ns();
    json["file_bytes"] = encoding.bytes_written();
    json["raw_bytes"] = written.sample_bytes() * timeline.sample_count();
    json["seconds"] = stopwatch.seconds();
    print_json(json);
    return 0;
  }
  if (ended_quietly(options, output)) return 0;

  const CaptureFormat& capture = encoding.source().capture;
  print_line(format("{}: {}, {}, {}, {} of {} raw, {:.2f} s", output.string(), shape_text(capture.shape),
                    counted(timeline.sample_count(), "sample"), timing_text(timeline, source_options),
                    bytes_text(encoding.bytes_written()),
                    bytes_text(capture.sample_bytes() * timeline.sample_count()), stopwatch.seconds()));
  for (const std::string& line : note_lines(notes, timeline, source_options)) print_note(line);
  return 0;
}

}  // namespace nutik::app
