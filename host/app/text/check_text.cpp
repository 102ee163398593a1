#include "app/text/check_text.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "app/text/text_table.hpp"
#include "session/format.hpp"
#include "session/size_text.hpp"
#include "session/time_text.hpp"

namespace nutik::app {
namespace {

using Severity = Finding::Severity;

constexpr std::size_t kExamples = 5;

std::string stops_text(const GainSummary& summary) {
  const auto stops = still_stops(summary);
  if (!stops) return "-";
  const double shown = std::round(*stops * 100) / 100;
  return shown == 0.0 ? "0" : format("{:+.2f}", shown);
}

}  // namespace

Finding CheckedFunctions::finding(Finding::Severity severity, std::string kind, std::uint8_t tag,
                                  std::size_t at, const std::string& message) const {
  return {severity,
          std::move(kind),
          name,
          format("M{}: {}", tag, message),
          source.place_of(at),
          source.excerpt(at),
          Json{{"mask_value", tag}}};
}

Finding blended_finding(const std::string& mask_name, const std::vector<BlendedValue>& blended) {
  std::uint64_t pixels = 0;
  std::string examples;
  Json values = Json::array();
  for (std::size_t i = 0; i < blended.size(); ++i) {
    const BlendedValue& value = blended[i];
    pixels += value.pixel_count;
    values.push_back(
        {{"mask_value", value.value}, {"pixels", value.pixel_count}, {"x", value.x}, {"y", value.y}});
    if (i >= kExamples) continue;
    examples += format("{}{} (first at {},{})", i == 0 ? "" : ", ", value.value, value.x, value.y);
  }
  return {Severity::warning,
          "blended_mask_values",
          mask_name,
          format("{} in between, on {} at edges: {}{}; edges were smoothed, or the mask was "
                 "scaled or kept as JPEG: paint it without smoothing and keep it as PGM or PNG",
                 counted(blended.size(), "value"), counted(pixels, "pixel"), examples,
                 blended.size() > kExamples ? ", …" : ""),
          std::nullopt,
          {},
          Json{{"values", values}}};
}

Finding speck_finding(const std::string& mask_name, const std::vector<MaskSpeck>& specks) {
  std::string examples;
  Json places = Json::array();
  for (std::size_t i = 0; i < specks.size(); ++i) {
    const MaskSpeck& speck = specks[i];
    places.push_back({{"x", speck.x}, {"y", speck.y}, {"pixels", speck.pixel_count}});
    if (i >= kExamples) continue;
    examples +=
        format("{}{},{} ({})", i == 0 ? "" : ", ", speck.x, speck.y, counted(speck.pixel_count, "pixel"));
  }
  return {Severity::warning,
          "mask_specks",
          mask_name,
          format("value {} has {} that may be slips of the brush: at {}{}", specks[0].tag,
                 counted(specks.size(), "speck"), examples, specks.size() > kExamples ? ", …" : ""),
          std::nullopt,
          {},
          Json{{"mask_value", specks[0].tag}, {"specks", places}}};
}

std::string heading_text(const CheckedInputs& checked) {
  std::string text;
  const auto append = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (checked.functions) {
    const std::size_t count =
        checked.functions->file.functions.size() + checked.functions->file.broken.size();
    append(format("{}: {}", checked.functions->name, counted(count, "function")));
  }
  if (checked.mask)
    append(format("{}: {} x {}", checked.mask->name, checked.mask->mask.width, checked.mask->mask.height));
  if (checked.capture && checked.capture->timeline) {
    append(format("{}: {}, {}, {}", checked.capture->name, shape_text(checked.capture->format.shape),
                  counted(checked.capture->timeline->sample_count(), "sample"),
                  duration_text(checked.domain.duration_ns)));
  } else if (checked.capture) {
    append(format("{}: {}, its length is not known before it is decoded", checked.capture->name,
                  shape_text(checked.capture->format.shape)));
  }
  if (checked.functions && !checked.domain.is_capture) {
    append(format("figures are for 0 … {}, not for a capture",
                  integral_text(static_cast<double>(checked.domain.duration_ns))));
  }
  return text.empty() ? "nothing could be read" : text;
}

std::string figures_text(const CheckedInputs& checked) {
  const auto is_known = [&](auto member) {
    return std::ranges::any_of(checked.figures,
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
  for (const FunctionFigures& figures : checked.figures) {
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

Json check_json(const CheckedInputs& checked) {
  Json functions = Json::array();
  for (const FunctionFigures& figures : checked.figures) {
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
  return Json{{"mistakes", checked.findings.count(Severity::error)},
              {"warnings", checked.findings.count(Severity::warning)},
              {"findings", checked.findings.json()},
              {"domain_end_ns", checked.domain.duration_ns},
              {"domain_is_capture", checked.domain.is_capture},
              {"functions", functions}};
}

}  // namespace nutik::app
