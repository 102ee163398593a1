#include <algorithm>
#include <array>

#include "app/output/output_name.hpp"
#include "app/output/report.hpp"
#include "app/run.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/picture.hpp"
#include "capture/timeline.hpp"
#include "features/activity/activity.hpp"
#include "features/captures/capture_figures.hpp"
#include "features/schema/option.hpp"
#include "features/schema/options.hpp"
#include "imev/expected_values.hpp"
#include "media/writers/picture_writer.hpp"
#include "session/text/number_text.hpp"
#include "session/text/shell_text.hpp"
#include "sheet/drawings.hpp"
#include "tik/header.hpp"
#include "tik/reader.hpp"

namespace nutik::app {
namespace {

// Returns how often the pixel that changes most does.
std::uint64_t write_activity(tik::Reader& reader, const std::string& path) {
  const std::vector<std::uint64_t> changes = measure_activity(reader, {}).activity.changes();
  write_picture(path, sheet::activity_map(reader.format().shape, changes));
  return *std::ranges::max_element(changes);
}

// How many samples were made behind each filmed one.
Json made_json(const std::optional<MadeSamples>& made) {
  if (!made) return nullptr;
  return {{"count", made->count()},
          {"after", made->after},
          {"changed_blocks", made->changed},
          {"unfollowed_blocks", made->unfollowed}};
}

Json alignment_json(const std::optional<tik::Alignment>& aligned, const Timeline& timeline) {
  if (!aligned) return nullptr;
  const bool is_there = aligned->reference < timeline.pictures().sample_count();
  return {{"motion", aligned->motion},
          {"reference_sample", is_there ? Json(timeline.sample_of(aligned->reference)) : Json()},
          {"holds_unseen", aligned->holds_unseen},
          {"moved_pixels", aligned->moved_pixels},
          {"turned_degrees", aligned->turned_degrees},
          {"residual_pixels", aligned->residual_pixels ? Json(*aligned->residual_pixels) : Json()}};
}

Json part_json(const std::optional<PartOfClip>& part) {
  if (!part) return nullptr;
  return {{"clip", part->clip}, {"first_picture", part->first},
          {"start_ns", part->start_ns}, {"pictures", part->pictures}};
}

// What is a change.
std::string change_text(const NoiseModel& noise) {
  if (noise.camera) return format("beyond {} sigmas of the noise", noise.sigmas);
  return format("tolerance {}{}", noise.tolerance, noise.is_lossless() ? " (lossless)" : "");
}

// Shares of white at which noise is told.
constexpr double kDark = 0.1, kBright = 0.9;

// `1.9 1.4 2.1 codes of the source at a tenth of white, 2.8 2.2 3.0 at nine tenths`
std::string noise_summary(const CameraNoise& noise) {
  std::string dark, bright;
  for (std::uint32_t channel = 0; channel < noise.channels.size(); ++channel) {
    dark += format("{:.3g} ", noise.sd(channel, kDark * noise.white_code));
    bright += format("{:.3g} ", noise.sd(channel, kBright * noise.white_code));
  }
  return format("{}codes of the source at a tenth of white, {}at nine tenths", dark, bright);
}

// In codes of the source, for each channel.
Json noise_json(const CaptureFormat& capture) {
  if (!capture.noise.camera) return nullptr;
  const CameraNoise& noise = *capture.noise.camera;
  Json json{{"sigmas", capture.noise.sigmas},
            {"source_white_code", noise.white_code},
            {"codes_times", held_scale(capture)}};
  for (std::uint32_t channel = 0; channel < noise.channels.size(); ++channel) {
    json["at_a_tenth_of_white"].push_back(noise.sd(channel, kDark * noise.white_code));
    json["at_nine_tenths"].push_back(noise.sd(channel, kBright * noise.white_code));
  }
  return json;
}

}  // namespace

int run_info(const Options& options) {
  if (options.operands.size() != 1) throw UsageError("info takes one capture: nutik-cl info clip.tik");
  const std::string& name = options.operands.front();
  tik::Reader reader(name);
  const CaptureFormat& capture = reader.format();
  const Timeline& timeline = reader.timeline();

  if (options.activity) {
    check_picture_output(*options.activity, 1, std::array{name}, replacing(options));
  }

  const CaptureFigures figures = figures_of(reader);
  for (const InputError& damage : figures.damage) print_warning(message_text(damage, Dialect::command_line));
  const int status =
      figures.damage.empty() ? ExitStatus::ok : ExitStatus::input;  // as any command that meets damaged input
  const auto& [still, rows, dense, records] = figures.tiles;
  const std::uint64_t raw_bytes = figures.raw_bytes;
  const auto share = [](std::uint64_t part, std::uint64_t whole) {
    return 100.0 * static_cast<double>(part) / static_cast<double>(std::max<std::uint64_t>(whole, 1));
  };

  if (options.json) {
    Json json{{"capture", name}, {"version", reader.header().version}};
    json.update(shape_json(capture.shape));
    json.update({{"code_bits", capture.code_bytes * 8},
                 {"white_code", capture.white_code},
                 {"transfer", capture.transfer.text()},
                 {"primaries", to_text(capture.primaries)},
                 {"pixel_aspect", aspect_text(capture.pixel_aspect)},
                 {"facts", facts_json(reader.header().facts)},
                 {"alignment", alignment_json(reader.header().alignment, reader.timeline())},
                 {"part", part_json(reader.header().part)},
                 {"made_samples", made_json(reader.header().made)},
                 {"tolerance_codes", capture.noise.tolerance},
                 {"has_camera_noise", capture.noise.camera.has_value()},
                 {"noise", noise_json(capture)},
                 {"samples", timeline.sample_count()},
                 {"blocks", reader.block_count()},
                 {"duration_ns", timeline.duration_ns()},
                 {"samples_a_second", timeline.rate().text()},
                 {"is_constant_rate", timeline.is_constant()},
                 {"shutter_angle_degrees", timeline.shutter_angle().text()},
                 {"records", figures.record_count},
                 {"are_records_exact", figures.is_record_count_exact},
                 {"tiles", {{"still", still}, {"rows", rows}, {"dense", dense}, {"records", records}}},
                 {"file_bytes", reader.file_bytes()},
                 {"raw_bytes", raw_bytes},
                 {"memory_bytes", figures.payload_bytes},
                 {"codec", reader.header().codec},
                 {"is_damaged", status != 0 ? Json(true) : Json()}});  // samples are not looked at
    if (options.activity) {
      write_activity(reader, *options.activity);
      json["activity"] = *options.activity;
    }
    json["warnings"] = printed_warnings();
    print_json(json);
    return status;
  }

  print_line(format("{}: a .tik capture, version {}", name, reader.header().version));
  print_line(format("  pictures    {}, {} bits, white code {}, transfer {}, primaries {}, pixels {}",
                    shape_text(capture.shape), capture.code_bytes * 8, capture.white_code,
                    capture.transfer.text(), to_text(capture.primaries), aspect_text(capture.pixel_aspect)));
  if (capture.noise.camera) {
    print_line(format("  codes       means of the source's, whose white code is {}, times {}",
                      capture.noise.camera->white_code, held_scale(capture)));
    print_line("  noise       " + noise_summary(*capture.noise.camera));
  }
  print_line(
      format("  samples     {} in {}", timeline.sample_count(), counted(reader.block_count(), "block")));
  print_line(format("  time        {}, {}{}, shutter {} degrees", duration_text(timeline.duration_ns()),
                    rate_text(timeline.rate(), "sample"),
                    timeline.is_constant() ? "" : " on average (irregular)",
                    timeline.shutter_angle().text()));
  if (const auto& aligned = reader.header().alignment)
    print_line("  aligned     " + alignment_text(*aligned));
  for (const std::string& fact : reader.header().facts) print_line("  taken for   " + fact);
  print_line(
      format("  changes     {}{:.2f} records a pixel, at {:.2f} % of samples, {}",
             figures.is_record_count_exact ? "" : "at most ",
             static_cast<double>(figures.record_count) / static_cast<double>(capture.shape.pixel_count()),
             share(figures.record_count, capture.shape.pixel_count() * timeline.sample_count()),
             change_text(capture.noise)));
  const std::uint64_t tiles = figures.tile_count();
  print_line(format("  tiles       {:.1f} % still, {:.1f} % rows, {:.1f} % dense, {:.1f} % records",
                    share(still, tiles), share(rows, tiles), share(dense, tiles), share(records, tiles)));
  print_line(format("  size        {} ({:.1f} % of {} raw), {} in memory, codec {}",
                    bytes_text(reader.file_bytes()), share(reader.file_bytes(), raw_bytes),
                    bytes_text(raw_bytes), bytes_text(figures.payload_bytes), reader.header().codec));
  if (options.activity) {
    const std::uint64_t most = write_activity(reader, *options.activity);
    print_line(format("  activity    {}: black never changes, white {} times", *options.activity, most));
  }
  print_line(format("try: nutik-cl --start {}f --exposure 1f {} picture.png", timeline.pictures().sample_count() / 2,
                    shell_word(name)));
  return status;
}

}  // namespace nutik::app
