#include "app/text/check_text.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "app/text/findings.hpp"
#include "app/text/text_table.hpp"
#include "session/below/format.hpp"
#include "session/text/size_text.hpp"
#include "session/text/time_text.hpp"

namespace nutik::app {
namespace {

std::string stops_text(const GainSummary& summary) {
  const auto stops = still_stops(summary);
  if (!stops) return "-";
  const double shown = std::round(*stops * 100) / 100;
  return shown == 0.0 ? "0" : format("{:+.2f}", shown);
}

}  // namespace

std::string heading_text(const InputCheck& check) {
  std::string text;
  const auto append = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (check.functions()) {
    const std::size_t count =
        check.functions()->file.functions.size() + check.functions()->file.broken.size();
    append(format("{}: {}", check.functions()->name, counted(count, "function")));
  }
  if (check.mask())
    append(format("{}: {} x {}", check.mask()->name, check.mask()->mask.width, check.mask()->mask.height));
  if (check.capture() && check.capture()->timeline) {
    append(format("{}: {}, {}, {}", check.capture()->name, shape_text(check.capture()->format.shape),
                  counted(check.capture()->timeline->sample_count(), "sample"),
                  duration_text(check.domain().duration_ns)));
  } else if (check.capture()) {
    append(format("{}: {}, its length is not known before it is decoded", check.capture()->name,
                  shape_text(check.capture()->format.shape)));
  }
  if (check.functions() && !check.domain().is_capture) {
    append(format("figures are for 0 … {}, not for a capture",
                  integral_text(static_cast<double>(check.domain().duration_ns))));
  }
  return text.empty() ? "nothing could be read" : text;
}

std::string figures_text(const InputCheck& check) {
  const auto is_known = [&](auto member) {
    return std::ranges::any_of(check.figures(),
                               [&](const auto& figures) { return (figures.*member).has_value(); });
  };
  const bool has_pixels = is_known(&FunctionFigures::pixels);
  const bool has_samples = is_known(&FunctionFigures::samples);
  const auto count = [](const std::optional<std::uint64_t>& number) {
    return number ? format("{}", *number) : std::string("-");
  };
  const auto time = [](std::int64_t ns) { return integral_text(static_cast<double>(ns)); };
  std::vector<std::vector<std::string>> rows;
  const auto add_row = [&](const std::string& function, const std::string& pixels,
                           std::vector<std::string> figures, const std::string& samples) {
    std::vector<std::string> row{function};
    if (has_pixels) row.push_back(pixels);
    std::ranges::move(figures, std::back_inserter(row));
    if (has_samples) row.push_back(samples);
    rows.push_back(std::move(row));
  };
  add_row("function", "pixels", {"live", "D", "∫g", "still gain", "stops"}, "samples");
  for (const FunctionFigures& figures : check.figures()) {
    const GainSummary& summary = figures.summary;
    const Interval& live = summary.live;
    add_row(format("M{}", figures.tag), count(figures.pixels),
            {live.empty() ? "never" : time(live.begin_ns) + " … " + time(live.end_ns),
             time(summary.support_ns), integral_text(std::scalbn(summary.integral_ns, summary.exponent)),
             format("{:.6g}", summary.still_gain()), stops_text(summary)},
            count(figures.samples));
  }
  return table_text(rows, std::string("l") + (has_pixels ? "r" : "") + "lrrrr" + (has_samples ? "r" : ""));
}

Json check_json(const InputCheck& check) {
  Json functions = Json::array();
  for (const FunctionFigures& figures : check.figures()) {
    const GainSummary& summary = figures.summary;
    const auto stops = still_stops(summary);
    Json function{{"mask_value", figures.tag},
                  {"pixels", figures.pixels ? Json(*figures.pixels) : Json()},
                  {"live_start_ns", summary.live.begin_ns},
                  {"live_end_ns", summary.live.end_ns},
                  {"nonzero_ns", summary.support_ns},
                  {"integral_ns", std::scalbn(summary.integral_ns, summary.exponent)},
                  {"still_gain", summary.still_gain()},
                  {"stops", stops ? Json(*stops) : Json()},
                  {"samples", figures.samples ? Json(*figures.samples) : Json()}};
    functions.push_back(std::move(function));
  }
  return Json{{"mistakes", count_of(check.findings(), Finding::Severity::error)},
              {"warnings", count_of(check.findings(), Finding::Severity::warning)},
              {"findings", findings_json(check.findings())},
              {"domain_end_ns", check.domain().duration_ns},
              {"domain_is_capture", check.domain().is_capture},
              {"functions", functions}};
}

}  // namespace nutik::app
