#include <cmath>
#include <optional>
#include <utility>

#include "app/commands/commands.hpp"
#include "app/commands/opened_session.hpp"
#include "app/output/output_name.hpp"
#include "app/output/report.hpp"
#include "app/requests/requests.hpp"
#include "app/text/number_text.hpp"
#include "app/text/trace_text.hpp"
#include "session/below/error.hpp"
#include "session/below/format.hpp"
#include "session/below/pictures.hpp"
#include "session/session.hpp"
#include "session/text/time_text.hpp"
#include "session/text/trace_picture.hpp"
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

// `the exposure`, `M128`, `M128 (79.99 %)`; a plain interval has no mask value.
std::string function_name(const TracedExposure& exposure, const Trace& trace, bool plain) {
  const std::string name = plain ? "the exposure" : format("M{}", exposure.function_of(trace).tag);
  return exposure.traces.size() == 1 ? name : format("{} ({})", name, share_text(trace));
}

Picture picture_of(const TracedExposure& exposure, const std::string& title, bool plain) {
  std::vector<Picture> pictures;
  for (const Trace& trace : exposure.traces) {
    if (trace.steps.empty()) continue;
    pictures.push_back(trace_picture(trace, exposure.function_of(trace),
                                     format("{}, {}", title, function_name(exposure, trace, plain))));
  }
  if (pictures.empty()) {
    throw InputError(
        format("{}, {}: the function is zero everywhere in the capture; there is nothing to draw", title,
               function_name(exposure, exposure.traces.front(), plain)));
  }
  return stacked(pictures);
}

// What each function came to.
std::string function_line(const TracedExposure& exposure, const Trace& trace, bool plain) {
  const GainSummary& summary = exposure.function_of(trace).summary;
  return format("{}: light {}; {} steps, D {}, ∫g {}", function_name(exposure, trace, plain),
                light_text({&trace, 1}), trace.steps.size(),
                integral_text(static_cast<double>(summary.support_ns)),
                integral_text(std::scalbn(summary.integral_ns, summary.exponent)));
}

}  // namespace

int run_trace(const Options& options) {
  const auto output = stated_output(options, "trace");
  const std::string& input = options.operands.front();
  const Traced traced = Traced::from(options);
  const ExposureRequest request = exposure_request(options);
  if (output) {
    if (!is_table_name(*output) && !is_picture_name(*output)) {
      throw UsageError(
          format("{}: traces are written as a table, .csv, or as a picture: .png, .tif, .jpg or .ppm",
                 output->string()));
    }
    if (is_table_name(*output)) {
      check_output(*output, OutputKind::table, input_files(options), replacing(options));
    } else {
      constexpr std::uint32_t kColour = 3;
      check_picture_output(*output, kColour, input_files(options), replacing(options));
    }
  }

  Session session = open_session(input, options, make_devices(options));
  const TracedExposure exposure = traced.follow(session, request);
  print_warnings(exposure.warnings);
  const std::vector<Trace>& traces = exposure.traces;
  const bool is_plain = !options.functions;
  const std::string title = format("{}, {}", input, traced.text(traces.front()));
  if (output && is_table_name(*output)) {
    write_text(*output, steps_csv(exposure));
  } else if (output) {
    write_picture(*output, picture_of(exposure, title, is_plain));
  }

  Answer answer{{{"capture", input}}};
  if (traced.pixel) answer.json.update({{"x", traced.pixel->first}, {"y", traced.pixel->second}});
  if (options.json) answer.json.update(trace_json(exposure));
  const bool is_mixed = traces.size() > 1;
  for (const Trace& trace : traces) {
    if (output || options.json) break;
    if (is_mixed) print_line(function_name(exposure, trace, is_plain));
    print_line(steps_text(trace, exposure.function_of(trace), options.verbose));
  }
  if (!options.quiet && !options.json) {
    const std::string place = (output ? output->string() + ": " : "") + title;
    const std::string codes = traced_codes(traces, exposure.figures.capture,
                                           output_format(output_request(options), session.format()));
    if (is_mixed) {
      print_line(
          format("{}: light {}, code {}, of {} functions", place, light_text(traces), codes, traces.size()));
      for (const Trace& trace : traces) print_line("  " + function_line(exposure, trace, is_plain));
    } else {
      const GainSummary& summary = exposure.function_of(traces[0]).summary;
      print_line(format("{}, {}: light {}, code {}; {} steps, D {}, ∫g {}", place,
                        function_name(exposure, traces[0], is_plain), light_text(traces), codes,
                        traces[0].steps.size(), integral_text(static_cast<double>(summary.support_ns)),
                        integral_text(std::scalbn(summary.integral_ns, summary.exponent))));
    }
  }
  answer.tell_source(session);
  return tell(options, input, answer, true);
}

}  // namespace nutik::app
