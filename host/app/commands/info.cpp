#include <algorithm>
#include <array>

#include "app/commands/commands.hpp"
#include "app/output/console.hpp"
#include "app/output/json.hpp"
#include "app/output/output_name.hpp"
#include "app/text/message_text.hpp"
#include "app/text/shell_text.hpp"
#include "session/activity.hpp"
#include "session/capture.hpp"
#include "session/clip_source.hpp"
#include "session/error.hpp"
#include "session/format.hpp"
#include "session/pictures.hpp"
#include "session/size_text.hpp"
#include "session/time_text.hpp"

namespace nutik::app {
namespace {

struct TileTally {
  std::uint64_t still = 0;
  std::uint64_t rows = 0;
  std::uint64_t dense = 0;
  std::uint64_t records = 0;

  void count(TileKind kind) {
    switch (kind) {
      case TileKind::still: ++still; break;
      case TileKind::rows: ++rows; break;
      case TileKind::dense: ++dense; break;
      case TileKind::records: ++records; break;
    }
  }
};

// Returns how often the pixel that changes most does.
std::uint64_t write_activity(tik::Reader& reader, const std::string& path) {
  Activity activity(reader.format());
  for_each_block(reader, [&](const BlockView& block) { activity.add(block); });
  write_picture(path, sheet::activity_map(reader.format().shape, activity.changes()));
  return *std::ranges::max_element(activity.changes());
}

// What is a change.
std::string change_text(const NoiseModel& noise) {
  if (noise.camera) return format("beyond {} sigmas of the noise", noise.sigmas);
  return format("tolerance {}{}", noise.tolerance, noise.is_lossless() ? " (lossless)" : "");
}

// A sample as it was before it was encoded.
std::uint64_t source_sample_bytes(const CaptureFormat& capture) {
  if (!capture.noise.camera) return capture.sample_bytes();
  return capture.shape.value_count() * (capture.noise.camera->white_code > 255 ? 2 : 1);
}

// `1.9 1.4 2.1 codes of the source at a tenth of white, 2.8 2.2 3.0 at nine tenths`
std::string noise_summary(const CameraNoise& noise) {
  std::string dark, bright;
  for (std::uint32_t channel = 0; channel < noise.channels.size(); ++channel) {
    dark += format("{:.3g} ", noise.sd(channel, 0.1 * noise.white_code));
    bright += format("{:.3g} ", noise.sd(channel, 0.9 * noise.white_code));
  }
  return format("{}codes of the source at a tenth of white, {}at nine tenths", dark, bright);
}

}  // namespace

int run_info(const Options& options) {
  if (options.operands.size() != 1) throw UsageError("info takes one capture: nutik-cl info clip.tik");
  const std::string& name = options.operands.front();
  tik::Reader reader(name);
  const CaptureFormat& capture = reader.format();
  const Timeline& timeline = reader.timeline();

  if (options.activity) check_output(*options.activity, OutputKind::picture, std::array{name});

  TileTally tally;
  std::uint64_t payload_bytes = 0, record_count = 0;
  bool is_damaged = false;
  for (std::uint64_t block = 0; block < reader.block_count(); ++block) {
    const BlockGeometry geometry(capture, reader.block_extent(block).sample_count);
    try {
      for (const TileEntry& entry : reader.directory(block)) tally.count(geometry.kind_of(entry));
    } catch (const InputError& error) {
      is_damaged = true;
      print_warning(message_text(error));
    }
    payload_bytes += reader.index()[block].payload_bytes;
    record_count += reader.index()[block].record_count;
  }
  const std::uint64_t raw_bytes = source_sample_bytes(capture) * timeline.sample_count();
  const auto share = [](std::uint64_t part, std::uint64_t whole) {
    return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
  };
  const std::uint64_t tiles =
      std::max<std::uint64_t>(1, tally.still + tally.rows + tally.dense + tally.records);

  if (options.json) {
    Json json{{"capture", name}, {"version", tik::kVersion}};
    add_shape(json, capture.shape);
    json["code_bits"] = capture.code_bytes * 8;
    json["white_code"] = capture.white_code;
    json["transfer"] = capture.transfer.text();
    json["tolerance_codes"] = capture.noise.tolerance;
    json["has_camera_noise"] = capture.noise.camera.has_value();
    json["samples"] = timeline.sample_count();
    json["blocks"] = reader.block_count();
    json["duration_ns"] = timeline.duration_ns();
    json["samples_a_second"] = timeline.rate().text();
    json["is_constant_rate"] = timeline.is_constant();
    json["shutter_angle_degrees"] = timeline.shutter_angle().text();
    json["records"] = record_count;
    json["tiles"] = {
        {"still", tally.still}, {"rows", tally.rows}, {"dense", tally.dense}, {"records", tally.records}};
    json["file_bytes"] = reader.file_bytes();
    json["raw_bytes"] = raw_bytes;
    json["memory_bytes"] = payload_bytes;
    json["codec"] = reader.header().codec;
    json["is_damaged"] = is_damaged;
    if (options.activity) {
      write_activity(reader, *options.activity);
      json["activity"] = *options.activity;
    }
    print_json(json);
    return is_damaged ? 3 : 0;
  }

  print_line(format("{}: a .tik capture, version {}", name, tik::kVersion));
  print_line(format("  pictures    {}, {} bits, white code {}, transfer {}", shape_text(capture.shape),
                    capture.code_bytes * 8, capture.white_code, capture.transfer.text()));
  if (capture.noise.camera) {
    print_line(format("  codes       means of the source's, whose white code is {}, times {}",
                      capture.noise.camera->white_code, held_scale(capture)));
    print_line("  noise       " + noise_summary(*capture.noise.camera));
  }
  print_line(
      format("  samples     {} in {}", timeline.sample_count(), counted(reader.block_count(), "block")));
  print_line(format("  time        {}, {} samples a second{}, shutter {} degrees",
                    duration_text(timeline.duration_ns()), timeline.rate().text(),
                    timeline.is_constant() ? "" : " on average (irregular)",
                    timeline.shutter_angle().text()));
  print_line(format("  changes     {:.2f} records a pixel, at {:.2f} % of samples, {}",
                    static_cast<double>(record_count) / static_cast<double>(capture.shape.pixel_count()),
                    share(record_count, capture.shape.pixel_count() * timeline.sample_count()),
                    change_text(capture.noise)));
  print_line(format("  tiles       {:.1f} % still, {:.1f} % rows, {:.1f} % dense, {:.1f} % records",
                    share(tally.still, tiles), share(tally.rows, tiles), share(tally.dense, tiles),
                    share(tally.records, tiles)));
  print_line(format("  size        {} ({:.1f} % of {} raw), {} in memory, codec {}",
                    bytes_text(reader.file_bytes()), share(reader.file_bytes(), raw_bytes),
                    bytes_text(raw_bytes), bytes_text(payload_bytes), reader.header().codec));
  if (options.activity) {
    const std::uint64_t most = write_activity(reader, *options.activity);
    print_line(format("  activity    {}: black never changes, white {} times", *options.activity, most));
  }
  print_line(format("try: nutik-cl --start {}f --exposure 1f {} picture.png", timeline.sample_count() / 2,
                    shell_word(name)));
  return is_damaged ? 3 : 0;  // as any command that meets damaged input
}

}  // namespace nutik::app
