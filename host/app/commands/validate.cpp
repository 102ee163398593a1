#include "app/command_line/option_table.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/opened_session.hpp"
#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "app/requests/requests.hpp"
#include "app/text/number_text.hpp"
#include "app/text/validation_text.hpp"
#include "session/below/error.hpp"
#include "session/below/format.hpp"
#include "session/clips/clip_source.hpp"
#include "session/clips/source_check.hpp"
#include "session/session.hpp"
#include "session/text/size_text.hpp"

namespace nutik::app {
namespace {

constexpr std::uint32_t kDefaultRuns = 5;
constexpr std::uint32_t kMaxRuns = 10'000;

// What codes are may be said of --source, where the capture is a .tik and needs no description.
Options options_of_capture(const Options& options) {
  Options own = options;
  if (!options.source || !is_tik(options.operands.front())) return own;
  for (const Option& option : app::options()) {
    if (option.scope == Scope::decoding) option.copy(own, Options());
  }
  return own;
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
  const std::uint32_t runs =
      options.runs ? parse_whole_number(*options.runs, "--runs", 1, kMaxRuns) : kDefaultRuns;
  const ExposureRequest request = exposure_request(options);
  const std::shared_ptr<Devices> devices = make_devices(options);
  const std::string device = devices->opencl().name();  // refused before a clip is read
  Session session = open_session(input, options_of_capture(options), devices);
  const Shape& shape = session.format().shape;
  const OutputFormat output = output_format(output_request(options), session.format());
  const auto [validation, figures, warnings] =
      session.validate(request, output, runs, progress_bar("rendering", options.quiet));
  print_warnings(warnings);
  std::optional<SourceCheck> source;
  if (options.source) {
    source = session.compare_with(clip_request(options, *options.source),
                                  progress_bar("comparing with the source", options.quiet));
  }

  Answer answer;
  if (options.json) {
    answer.json = validation_json(validation, figures, input, device, runs);
    if (source) answer.json["source"] = source_json(*source, shape, *options.source);
  } else {
    if (!options.quiet) {
      print_line(format("{}: {}, {} of {} samples, as {}; medians of {} on {}", input, shape_text(shape),
                        figures.live_samples, session.timeline().sample_count(), format_name(output.type),
                        runs, device));
    }
    print_line(variants_text(validation));
    if (!options.quiet) print_line(choice_text(validation));
    if (source) print_line(source_text(*source, shape, *options.source));
  }
  answer.tell_source(session);
  if (source && source->clip_goes_on) {
    answer.notes.push_back(format("{} goes on after the capture's last sample", *options.source));
  }
  tell(options, input, answer, true);
  const bool is_true = !source || source->comparison.values_beyond() == 0;
  if (!is_true) print_error(format("the capture is not true to {}: was it made from it?", *options.source));
  if (!validation.is_within_bounds()) {
    print_error("an arithmetic exceeds its bound: the device computes wrongly, or there is a fault here");
  }
  return is_true && validation.is_within_bounds() ? 0 : 1;
}

}  // namespace nutik::app
