#include <cmath>
#include <string>

#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "app/run.hpp"
#include "app/words/stated_requests.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/schema/option.hpp"
#include "features/schema/options.hpp"
#include "session/clips/source_check.hpp"
#include "session/session.hpp"
#include "session/text/number_text.hpp"
#include "session/text/text_table.hpp"

namespace nutik::app {
namespace {

// What a validation came to, for people and for scripts.

// A figure of kernels' times; null if the driver does not time them.
Json timed(const ValidatedVariant& variant, double figure) {
  return variant.is_timed ? Json(figure) : Json(nullptr);
}

// `8-bit codes`, `floats`
std::string format_name(ValueType type) {
  switch (type) {
    case ValueType::code8: return "8-bit codes";
    case ValueType::code16: return "16-bit codes";
    case ValueType::light32: return "floats";
    case ValueType::light64: break;
  }
  return "doubles";
}

// A row for each arithmetic, and one for the reference; what `auto` takes has a star.
std::string variants_text(const Validation& validation) {
  const bool codes = holds_codes(validation.output.type);
  std::vector<std::vector<std::string>> rows{
      {"", "", "kernel ms", "GB/s", "render ms", "worst light", "RMS light", "8-bit", "16-bit",
       codes ? "codes differ" : "floats differ", codes ? "at an edge" : "within bound", "bound", "used"}};
  for (std::size_t i = 0; i < validation.variants.size(); ++i) {
    const ValidatedVariant& variant = validation.variants[i];
    const LightErrors& light = variant.light;
    const StoredErrors& stored = variant.stored;
    const double share = 100.0 * static_cast<double>(stored.differing) / static_cast<double>(stored.values);
    rows.push_back({i == validation.chosen ? "*" : "", to_text(variant.precision()),
                    variant.is_timed ? format("{:.2f}", variant.expose_ms) : "not timed",
                    variant.is_timed ? format("{:.1f}", variant.gigabytes_per_second()) : "-",
                    format("{:.2f}", variant.render_ms), format("{:.2g}", light.worst),
                    format("{:.2g}", light.rms), format("{:.2g}", light.worst_8_bit_codes),
                    format("{:.2g}", light.worst_16_bit_codes), format("{:.3g} %", share),
                    format("{} of {}", stored.explained, stored.differing),
                    format("{:.2g}", variant.bound.worst.light),
                    format("{:.2g}{}", light.share_of_bound, variant.is_within_bound() ? "" : "  EXCEEDED")});
  }
  std::vector<std::string> reference(rows.front().size());
  reference[1] = "reference";
  reference[4] = format("{:.2f}", validation.reference_ms);
  rows.push_back(std::move(reference));
  return table_text(rows, "llrrrrrrrrrrl");
}

// What `auto` takes, and how right that is sure to be.
std::string choice_text(const Validation& validation) {
  const ErrorBound& bound = validation.variants[validation.chosen].bound;
  return format("* what --precision auto takes: {}{}", error_text(bound.worst, validation.output),
                bound.worst.steps <= kMaxSteps ? "" : "; nothing is sure to be right to half of one");
}

Json variants_json(const Validation& validation, const Shape& shape) {
  Json json = Json::array();
  for (std::size_t i = 0; i < validation.variants.size(); ++i) {
    const ValidatedVariant& variant = validation.variants[i];
    const LightErrors& light = variant.light;
    const std::uint64_t pixel = light.worst_value / shape.channels;
    json.push_back({{"precision", to_text(variant.precision())},
                    {"is_chosen", i == validation.chosen},
                    {"expose_ms", timed(variant, variant.expose_ms)},
                    {"develop_ms", timed(variant, variant.develop_ms)},
                    {"render_ms", variant.render_ms},
                    {"payload_bytes", variant.payload_bytes},
                    {"gigabytes_per_second", timed(variant, variant.gigabytes_per_second())},
                    {"worst_light", light.worst},
                    {"worst_x", pixel % shape.width},
                    {"worst_y", pixel / shape.width},
                    {"worst_channel", light.worst_value % shape.channels},
                    {"rms_light", light.rms},
                    {"worst_8_bit_codes", light.worst_8_bit_codes},
                    {"worst_16_bit_codes", light.worst_16_bit_codes},
                    {"values", variant.stored.values},
                    {"values_differing", variant.stored.differing},
                    {"values_differing_within_bound", variant.stored.explained},
                    {"bound_light", variant.bound.worst.light},
                    {"bound_steps", variant.bound.worst.steps},
                    {"share_of_bound", light.share_of_bound},
                    {"is_within_bound", variant.is_within_bound()}});
  }
  return json;
}

std::string source_text(const SourceCheck& check, const Shape& shape, const std::string& clip) {
  const SourceComparison& comparison = check.comparison;
  const auto& worst = comparison.worst();
  std::string text =
      std::isinf(comparison.psnr())
          ? format("{}: held exactly", clip)
          : format(
                "{}: PSNR {:.2f} dB, worst error {:.4g} codes at sample {}, pixel {},{}; {} of {} values "
                "further off than the capture permits",
                clip, comparison.psnr(), worst.error, worst.sample, worst.pixel % shape.width,
                worst.pixel / shape.width, comparison.values_beyond(), comparison.value_count());
  text += format("; {:.2f} change records a pixel, {} of {}",
                 static_cast<double>(comparison.record_count()) / static_cast<double>(shape.pixel_count()),
                 bytes_text(check.file_bytes), bytes_text(check.source_bytes));
  if (check.made_samples > 0)
    text += format("; {} made between its pictures not compared", counted(check.made_samples, "sample"));
  return text;
}

Json source_json(const SourceCheck& check, const Shape& shape, const std::string& clip) {
  const SourceComparison& comparison = check.comparison;
  const auto& worst = comparison.worst();
  Json json{{"clip", clip}, {"psnr_db", nullptr}};
  if (std::isfinite(comparison.psnr())) json["psnr_db"] = comparison.psnr();
  json.update({{"worst_codes", worst.error},
               {"worst_sample", worst.sample},
               {"worst_x", worst.pixel % shape.width},
               {"worst_y", worst.pixel / shape.width},
               {"values", comparison.value_count()},
               {"values_beyond", comparison.values_beyond()},
               {"records", comparison.record_count()},
               {"file_bytes", check.file_bytes},
               {"source_bytes", check.source_bytes},
               {"made_samples", check.made_samples}});
  return json;
}

// What codes are may be said of --source, where the capture is a .tik and needs no description.
Options options_of_capture(const Options& options) {
  if (!options.source_clip || !is_tik(options.operands.front())) return options;
  return without(options, Scope::decoding);
}

Json validation_json(const Validation& validation, const ExposureFigures& figures, const std::string& input,
                     const std::string& device, std::uint32_t runs) {
  Json json{{"capture", input}, {"device", device}};
  json.update(shape_json(figures.capture.shape));
  json.update({{"live_samples", figures.live_samples}, {"format", format_name(validation.output.type)}});
  if (holds_codes(validation.output.type)) json["white_code"] = validation.output.white_code;
  json.update({{"runs", runs},
               {"reference_render_ms", validation.reference_ms},
               {"variants", variants_json(validation, figures.capture.shape)},
               {"is_within_bounds", validation.is_within_bounds()}});
  return json;
}

}  // namespace

int run_validate(const Options& options) {
  if (options.operands.size() != 1) {
    throw UsageError(
        "validate takes one capture or clip: nutik-cl validate --start 0s --exposure 1s clip.tik");
  }
  const std::string& input = options.operands.front();
  const std::uint32_t runs = options.runs;
  const ExposureRequest request = exposure_request(options);
  const std::shared_ptr<Devices> devices = make_devices(options);
  const std::string device = devices->opencl()->name();  // refused before a clip is read
  Session session = open_session(input, options_of_capture(options), devices);
  const Shape& shape = session.format().shape;
  const OutputFormat output = output_format(options.picture, session.format());
  const auto [validation, figures, warnings] =
      session.validate(request, output, runs, progress_bar("rendering", options.quiet));
  print_warnings(warnings);
  std::optional<SourceCheck> source;
  if (options.source_clip) {
    source = session.compare_with(clip_request(options, *options.source_clip),
                                  progress_bar("comparing with the source", options.quiet));
  }

  Answer answer;
  if (options.json) {
    answer.json = validation_json(validation, figures, input, device, runs);
    if (source) answer.json["source"] = source_json(*source, shape, *options.source_clip);
  } else {
    if (!options.quiet) {
      print_line(format("{}: {}, {} of {} samples, as {}; medians of {} on {}", input, shape_text(shape),
                        figures.live_samples, session.timeline().sample_count(), format_name(output.type),
                        runs, device));
    }
    print_line(variants_text(validation));
    if (!options.quiet) print_line(choice_text(validation));
    if (source) print_line(source_text(*source, shape, *options.source_clip));
  }
  answer.tell_source(session);
  if (source && source->clip_goes_on) {
    answer.notes.push_back(format("{} goes on after the capture's last sample", *options.source_clip));
  }
  tell(options, input, answer, true);
  const bool is_true = !source || source->comparison.values_beyond() == 0;
  if (!is_true) {
    print_error(format("the capture is not true to {}: was it made from it, with the same options?{}",
                       *options.source_clip,
                       session.capture().header().roundings.are_known()
                           ? ""
                           : " An earlier version encoded it, and may have decoded, aligned or deflickered otherwise"));
  }
  if (!validation.is_within_bounds()) {
    print_error("an arithmetic exceeds its bound: the device computes wrongly, or there is a fault here");
  }
  return is_true && validation.is_within_bounds() ? ExitStatus::ok : ExitStatus::other;
}

}  // namespace nutik::app
