#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "app/words/stated_requests.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/schema/options.hpp"
#include "media/writers/picture_writer.hpp"
#include "session/session.hpp"
#include "session/text/number_text.hpp"
#include "session/text/text_table.hpp"
#include "session/trace_picture.hpp"
#include "system/output_file.hpp"

namespace nutik::app {
namespace {

// A trace for people, for spreadsheets and for scripts.
//
// What a step adds, and the sum, are shown to people as shares of the exposure: integrals divided by D, so
// that the last sum is the light of the picture. Tables and JSON have the integrals themselves.

// Rows of a run that are shown at its beginning and at its end, where it is folded.
constexpr std::size_t kShownAtEnds = 2;

std::string number(double value) { return format("{:.6g}", value); }

std::string line_text(double begin, double end) {
  return begin == end ? number(begin) : number(begin) + " → " + number(end);
}

// One number for each channel.
template <typename Text>
std::string by_channel(const Trace& trace, Text text) {
  std::string all;
  for (std::uint32_t channel = 0; channel < trace.channels; ++channel) {
    all += (channel == 0 ? "" : "  ") + text(channel);
  }
  return all;
}

double share_of(const Trace& trace) { return static_cast<double>(trace.share) / kWholeShare; }

bool has_made(const Trace& trace) { return std::ranges::any_of(trace.steps, &TraceStep::is_made); }

bool is_zero(const TraceStep& step) { return step.begin_gain == 0.0 && step.end_gain == 0.0; }

// A row for each step. Unless all are wanted, the middle of a long run between two control points is folded
// into one row.
std::string steps_text(const Trace& trace, const PlannedFunction& function, bool all) {
  const double support_ns = std::max(1.0, static_cast<double>(function.summary.support_ns));
  std::vector<std::vector<std::string>> rows{
      {"from ns", "to ns", "gain", trace.channels == 1 ? "light" : "light: red  green  blue", "adds", "sum"}};
  const bool has_marks = has_made(trace);
  if (has_marks) rows.front().emplace_back("sample");
  // Steps [first, last) as one row.
  const auto add_row = [&](std::size_t first, std::size_t last, const std::string& light, const char* mark) {
    const TraceStep &begin = trace.steps[first], &end = trace.steps[last - 1];
    std::array<double, 3> added{};
    for (std::size_t i = first; i < last; ++i) {
      for (std::uint32_t channel = 0; channel < trace.channels; ++channel)
        added[channel] += trace.steps[i].values[channel].integral_ns;
    }
    const auto sum = [&](std::uint32_t channel) { return number(end.values[channel].sum_ns / support_ns); };
    rows.push_back(
        {format("{}", begin.begin_ns), format("{}", end.end_ns), line_text(begin.begin_gain, end.end_gain), light,
         by_channel(trace, [&](std::uint32_t channel) { return number(added[channel] / support_ns); }),
         by_channel(trace, sum)});
    if (has_marks) rows.back().emplace_back(mark);
  };
  const auto add_steps = [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const TraceStep& step = trace.steps[i];
      const auto light = [&](std::uint32_t channel) {
        return line_text(step.values[channel].begin_light, step.values[channel].end_light);
      };
      add_row(i, i + 1, by_channel(trace, light), step.is_made ? "made" : "filmed");
    }
  };

  const auto points = function.function.points();
  for (std::size_t first = 0; first < trace.steps.size();) {
    // To the next control point.
    const auto next =
        std::ranges::upper_bound(points, trace.steps[first].begin_ns, {}, &ControlPoint::time_ns);
    std::size_t last = first + 1;
    while (last < trace.steps.size() &&
           (next == points.end() || trace.steps[last].begin_ns < next->time_ns)) {
      ++last;
    }
    const bool is_dark = is_zero(trace.steps[first]) && is_zero(trace.steps[last - 1]);
    const std::size_t shown = is_dark ? 0 : kShownAtEnds;
    if (all || last - first <= 2 * shown + 1) {
      add_steps(first, last);
    } else {
      add_steps(first, first + shown);
      add_row(first + shown, last - shown, format("({} steps)", last - first - 2 * shown), "");
      add_steps(last - shown, last);
    }
    first = last;
  }
  return table_text(rows, has_marks ? "rrlllll" : "rrllll");
}

// begin_ns,end_ns,begin_gain,end_gain, then for each channel its begin_light, end_light, integral_ns and sum_ns. Of a
// pixel that functions share each row begins with mask_value,share.
std::string steps_csv(const TracedExposure& exposure) {
  const bool is_mixed = exposure.traces.size() > 1;
  const std::uint32_t channels = exposure.traces.front().channels;
  std::string text = is_mixed ? "mask_value,share," : "";
  const bool has_marks = std::ranges::any_of(exposure.traces, has_made);
  text += "begin_ns,end_ns,begin_gain,end_gain";
  for (std::uint32_t channel = 0; channel < channels; ++channel) {
    for (const char* column : {"begin_light", "end_light", "integral_ns", "sum_ns"}) {
      text += format(",{}_{}", channel_name(channels, channel), column);
    }
  }
  if (has_marks) text += ",is_made";
  for (const Trace& trace : exposure.traces) {
    const std::string function =
        is_mixed ? format("{},{},", exposure.function_of(trace).tag, share_of(trace)) : std::string();
    for (const TraceStep& step : trace.steps) {
      text += format("\n{}{},{},{},{}", function, step.begin_ns, step.end_ns, step.begin_gain, step.end_gain);
      for (std::uint32_t channel = 0; channel < channels; ++channel) {
        const TraceStep::Value& value = step.values[channel];
        text += format(",{},{},{},{}", value.begin_light, value.end_light, value.integral_ns, value.sum_ns);
      }
      if (has_marks) text += step.is_made ? ",1" : ",0";
    }
  }
  return text + "\n";
}

Json light_json(const std::array<double, 3>& light, std::uint32_t channels) {
  Json values = Json::array();
  for (std::uint32_t channel = 0; channel < channels; ++channel) values.push_back(light[channel]);
  return values;
}

Json function_json(const Trace& trace, const PlannedFunction& function) {
  const GainSummary& summary = function.summary;
  Json steps = Json::array();
  for (const TraceStep& step : trace.steps) {
    Json values = Json::array();
    for (std::uint32_t channel = 0; channel < trace.channels; ++channel) {
      const TraceStep::Value& value = step.values[channel];
      values.push_back({{"begin_light", value.begin_light},
                        {"end_light", value.end_light},
                        {"integral_ns", value.integral_ns},
                        {"sum_ns", value.sum_ns}});
    }
    steps.push_back({{"begin_ns", step.begin_ns},
                     {"end_ns", step.end_ns},
                     {"begin_gain", step.begin_gain},
                     {"end_gain", step.end_gain},
                     {"values", values}});
    if (step.is_made) steps.back()["is_made"] = true;
  }
  return Json{{"mask_value", function.tag},
              {"pixels", trace.pixel_count},
              {"nonzero_ns", summary.support_ns},
              {"integral_ns", std::scalbn(summary.integral_ns, summary.exponent)},
              {"still_gain", summary.still_gain()},
              {"light", light_json(trace.light, trace.channels)},
              {"steps", steps}};
}

// A pixel that functions share: its light, and under `functions` each of them.
Json trace_json(const TracedExposure& exposure) {
  const std::vector<Trace>& traces = exposure.traces;
  if (traces.size() == 1) return function_json(traces[0], exposure.function_of(traces[0]));
  Json json{{"light", light_json(light_of(traces), traces[0].channels)}, {"functions", Json::array()}};
  for (const Trace& trace : traces) {
    Json& function = json["functions"].emplace_back(function_json(trace, exposure.function_of(trace)));
    function["share"] = share_of(trace);
  }
  return json;
}

// `79.99 %`: what of a pixel's light a trace's function has.
std::string share_text(const Trace& trace) { return format("{:.4g} %", 100 * share_of(trace)); }

Followed followed_of(const Options& options) {
  if (options.pixel.has_value() == options.tag.has_value()) {
    throw UsageError("what should be followed? Either --pixel X,Y or --tag VALUE of a mask");
  }
  if (options.pixel) return TracedPixel{options.pixel->first, options.pixel->second};
  if (!options.mask) throw UsageError("--tag is a value of a mask; add -m mask.pgm");
  return TracedTag{*options.tag};
}

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

// What a function came to.
std::string sums_text(const TracedExposure& exposure, const Trace& trace) {
  const GainSummary& summary = exposure.function_of(trace).summary;
  return format("{} steps, D {}, ∫g {}", trace.steps.size(),
                integral_text(static_cast<double>(summary.support_ns)),
                integral_text(std::scalbn(summary.integral_ns, summary.exponent)));
}

}  // namespace

int run_trace(const Options& options) {
  const auto output = stated_output(options, "trace");
  const std::string& input = options.operands.front();
  const Followed followed = followed_of(options);
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
  const TracedExposure exposure = session.trace(request, followed, progress_bar("tracing", options.quiet));
  print_warnings(exposure.warnings);
  const std::vector<Trace>& traces = exposure.traces;
  const bool is_plain = !options.functions;
  const std::string what = options.pixel ? format("pixel {},{}", options.pixel->first, options.pixel->second)
                                         : format("mean of {} pixels with {}mask value {}", traces.front().pixel_count,
                                                  options.feather ? "a share of " : "", *options.tag);
  const std::string title = format("{}, {}", input, what);
  if (output && is_table_name(*output)) {
    write_text(*output, steps_csv(exposure));
  } else if (output) {
    write_picture(*output, picture_of(exposure, title, is_plain));
  }

  Answer answer{{{"capture", input}}};
  if (options.pixel) answer.json.update({{"x", options.pixel->first}, {"y", options.pixel->second}});
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
                                           output_format(options.picture, session.format()));
    if (is_mixed) {
      print_line(
          format("{}: light {}, code {}, of {} functions", place, light_text(traces), codes, traces.size()));
      for (const Trace& trace : traces) {
        print_line(format("  {}: light {}; {}", function_name(exposure, trace, is_plain), light_text({&trace, 1}),
                          sums_text(exposure, trace)));
      }
    } else {
      print_line(format("{}, {}: light {}, code {}; {}", place, function_name(exposure, traces[0], is_plain),
                        light_text(traces), codes, sums_text(exposure, traces[0])));
    }
  }
  answer.tell_source(session);
  return tell(options, input, answer, true);
}

}  // namespace nutik::app
