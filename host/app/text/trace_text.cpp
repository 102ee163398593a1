#include "app/text/trace_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "app/text/text_table.hpp"
#include "session/below/format.hpp"

namespace nutik::app {
namespace {

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

bool is_zero(const TraceStep& step) { return step.begin_gain == 0.0 && step.end_gain == 0.0; }

}  // namespace

std::string steps_text(const Trace& trace, const PlannedFunction& function, bool all) {
  const double support_ns = std::max(1.0, static_cast<double>(function.summary.support_ns));
  std::vector<std::vector<std::string>> rows{
      {"from ns", "to ns", "gain", trace.channels == 1 ? "light" : "light: red  green  blue", "adds", "sum"}};
  const auto add_step = [&](const TraceStep& step) {
    rows.push_back(
        {format("{}", step.begin_ns), format("{}", step.end_ns), line_text(step.begin_gain, step.end_gain),
         by_channel(trace,
                    [&](std::uint32_t channel) {
                      return line_text(step.values[channel].begin_light, step.values[channel].end_light);
                    }),
         by_channel(
             trace,
             [&](std::uint32_t channel) { return number(step.values[channel].integral_ns / support_ns); }),
         by_channel(trace, [&](std::uint32_t channel) {
           return number(step.values[channel].sum_ns / support_ns);
         })});
  };
  // Steps [first, last) as one row.
  const auto add_fold = [&](std::size_t first, std::size_t last) {
    const TraceStep& begin = trace.steps[first];
    const TraceStep& end = trace.steps[last - 1];
    std::array<double, 3> added{};
    for (std::size_t i = first; i < last; ++i) {
      for (std::uint32_t channel = 0; channel < trace.channels; ++channel) {
        added[channel] += trace.steps[i].values[channel].integral_ns;
      }
    }
    rows.push_back(
        {format("{}", begin.begin_ns), format("{}", end.end_ns), line_text(begin.begin_gain, end.end_gain),
         format("({} steps)", last - first),
         by_channel(trace, [&](std::uint32_t channel) { return number(added[channel] / support_ns); }),
         by_channel(trace,
                    [&](std::uint32_t channel) { return number(end.values[channel].sum_ns / support_ns); })});
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
      for (std::size_t i = first; i < last; ++i) add_step(trace.steps[i]);
    } else {
      for (std::size_t i = first; i < first + shown; ++i) add_step(trace.steps[i]);
      add_fold(first + shown, last - shown);
      for (std::size_t i = last - shown; i < last; ++i) add_step(trace.steps[i]);
    }
    first = last;
  }
  return table_text(rows, "rrllll");
}

std::string steps_csv(const TracedExposure& exposure) {
  const bool is_mixed = exposure.traces.size() > 1;
  const std::uint32_t channels = exposure.traces.front().channels;
  std::string text = is_mixed ? "mask_value,share," : "";
  text += "begin_ns,end_ns,begin_gain,end_gain";
  for (std::uint32_t channel = 0; channel < channels; ++channel) {
    for (const char* column : {"begin_light", "end_light", "integral_ns", "sum_ns"}) {
      text += format(",{}_{}", channel_name(channels, channel), column);
    }
  }
  for (const Trace& trace : exposure.traces) {
    const std::string function =
        is_mixed ? format("{},{},", exposure.function_of(trace).tag, share_of(trace)) : std::string();
    for (const TraceStep& step : trace.steps) {
      text += format("\n{}{},{},{},{}", function, step.begin_ns, step.end_ns, step.begin_gain, step.end_gain);
      for (std::uint32_t channel = 0; channel < channels; ++channel) {
        const TraceStep::Value& value = step.values[channel];
        text += format(",{},{},{},{}", value.begin_light, value.end_light, value.integral_ns, value.sum_ns);
      }
    }
  }
  return text + "\n";
}

namespace {

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
  }
  return Json{{"mask_value", function.tag},
              {"pixels", trace.pixel_count},
              {"nonzero_ns", summary.support_ns},
              {"integral_ns", std::scalbn(summary.integral_ns, summary.exponent)},
              {"still_gain", summary.still_gain()},
              {"light", light_json(trace.light, trace.channels)},
              {"steps", steps}};
}

}  // namespace

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

std::string share_text(const Trace& trace) { return format("{:.4g} %", 100 * share_of(trace)); }

}  // namespace nutik::app
