#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "app/commands/commands.hpp"
#include "app/commands/opened_session.hpp"
#include "app/output/output_name.hpp"
#include "app/requests/requests.hpp"
#include "app/text/number_text.hpp"
#include "app/text/trace_text.hpp"
#include "session/error.hpp"
#include "session/format.hpp"
#include "session/pictures.hpp"
#include "session/session.hpp"
#include "session/time_text.hpp"
#include "session/trace_picture.hpp"
#include "system/output_file.hpp"

namespace nutik::app {
namespace {

// What is followed: a pixel, or all pixels of a mask value.
struct Traced {
  std::optional<std::pair<std::uint32_t, std::uint32_t>> pixel;
  std::uint8_t tag = 0;

  static Traced from(const Options& options) {
    if (options.pixel.has_value() == options.tag.has_value()) {
      throw UsageError("what should be followed? Either --pixel X,Y or --tag VALUE of a mask");
    }
    Traced traced;
    if (options.tag) {
      if (!options.mask) throw UsageError("--tag is a value of a mask; add -m mask.pgm");
      traced.tag = static_cast<std::uint8_t>(parse_whole_number(*options.tag, "tag", 0, 255));
      return traced;
    }
    constexpr std::uint32_t kLast = 65'535;
    traced.pixel =
        parse_pair(*options.pixel, ',', {"pixel column", 0, kLast}, {"pixel row", 0, kLast},
                   format("pixel '{}' is no place; write its column and row from 0 on: --pixel 320,180",
                          *options.pixel));
    return traced;
  }

  [[nodiscard]] TracedExposure follow(Session& session, const ExposureRequest& request) const {
    return pixel ? session.trace(request, TracedPixel{pixel->first, pixel->second})
                 : session.trace(request, TracedTag{tag});
  }

  [[nodiscard]] std::string text(const Trace& trace) const {
    return pixel ? format("pixel {},{}", pixel->first, pixel->second)
                 : format("mean of {} pixels with mask value {}", trace.pixel_count, tag);
  }
};

bool is_table_name(const std::filesystem::path& path) { return path.extension() == ".csv"; }

// `clip.tik, pixel 3,4, M128`; a plain interval has no mask value.
std::string heading(const std::string& name, const Traced& traced, const Trace& trace,
                    const PlannedFunction& function, bool plain) {
  return format("{}, {}, {}", name, traced.text(trace), plain ? "the exposure" : format("M{}", function.tag));
}

}  // namespace

int run_trace(const Options& options) {
  const auto output = stated_output(options, "trace");
  const std::string& input = options.operands.front();
  const Traced traced = Traced::from(options);
  const ExposureRequest request = exposure_request(options);
  if (output) {
    if (!is_table_name(*output) && !is_picture_name(*output)) {
      throw UsageError(format("{}: traces are written as a table, .csv, or as a picture: .png, .tif, .jpg or .ppm",
                              output->string()));
    }
    if (is_table_name(*output)) {
      check_output(*output, OutputKind::table, input_files(options));
    } else {
      constexpr std::uint32_t kColour = 3;
      check_picture_output(*output, kColour, input_files(options));
    }
  }

  Session session = open_session(input, options, make_devices(options));
  const TracedExposure exposure = traced.follow(session, request);
  print_warnings(exposure.warnings);
  const Trace& trace = exposure.trace;
  const PlannedFunction& function = exposure.function();
  const std::string title = heading(input, traced, trace, function, !options.functions);
  if (output && is_table_name(*output)) {
    write_text(*output, steps_csv(trace));
  } else if (output) {
    if (trace.steps.empty()) {
      throw InputError(
          format("{}: the function is zero everywhere in the capture; there is nothing to draw", title));
    }
    write_picture(*output, trace_picture(trace, function, title));
  }

  if (options.json) {
    Json json{{"capture", input}};
    if (traced.pixel) json.update({{"x", traced.pixel->first}, {"y", traced.pixel->second}});
    json.update(trace_json(trace, function));
    print_json(json);
    return 0;
  }
  if (!output) print_line(steps_text(trace, function, options.verbose));
  if (!options.quiet) {
    const GainSummary& summary = function.summary;
    print_line(format("{}{}: light {}, code {}; {} steps, D {}, ∫g {}", output ? output->string() + ": " : "",
                      title, light_text(trace),
                      traced_codes(trace, exposure.figures.capture,
                                   output_format(output_request(options), session.format())),
                      trace.steps.size(), integral_text(static_cast<double>(summary.support_ns)),
                      integral_text(std::scalbn(summary.integral_ns, summary.exponent))));
    print_source(session, options);
  }
  return 0;
}

}  // namespace nutik::app
