#include "session/trace_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "capture/format.hpp"
#include "plot/graph.hpp"
#include "render/code_scale.hpp"
#include "session/text/number_text.hpp"

namespace nutik {
namespace {

using plot::Point;

constexpr std::uint32_t kWidth = 1120;
constexpr std::uint32_t kHeight = 796;
constexpr double kLeft = 92;
constexpr double kRight = 28;
constexpr double kTop = 78;
constexpr double kGraphHeight = 190;
constexpr double kBetween = 46;
constexpr int kTimeTicks = 10;
constexpr int kValueTicks = 5;
constexpr double kMarginShare = 0.06;  // of the live interval, on either side

constexpr std::array<plot::Colour, 3> kChannelColours{plot::kPalette[1], plot::kPalette[2],
                                                      plot::kPalette[0]};

plot::Colour channel_colour(const Trace& trace, std::uint32_t channel) {
  return trace.channels == 1 ? plot::kText : kChannelColours[channel];
}

Interval shown_range(const Trace& trace, const PlannedFunction& function) {
  const Interval all{trace.steps.front().begin_ns, trace.steps.back().end_ns};
  const Interval& live = function.summary.live;
  if (live.empty()) return all;
  const auto margin =
      static_cast<std::int64_t>(std::ceil(kMarginShare * static_cast<double>(live.end_ns - live.begin_ns)));
  return {std::max(all.begin_ns, live.begin_ns - margin), std::min(all.end_ns, live.end_ns + margin)};
}

// Lines through the steps that are shown; two points at one time where a value jumps.
class Lines {
 public:
  Lines(const Trace& trace, const Interval& range) : channels_(trace.channels) {
    for (const TraceStep& step : trace.steps) {
      if (step.end_ns <= range.begin_ns || step.begin_ns >= range.end_ns) continue;
      add(step);
    }
  }

  std::vector<Point> gain;
  std::array<std::vector<Point>, 3> light;
  std::array<std::vector<Point>, 3> product;
  std::vector<Point> mean_product;  // of the channels

 private:
  void add(const TraceStep& step) {
    // A product of two ramps is a parabola; this many chords look like one.
    constexpr int kChords = 8;
    const bool is_curved =
        step.begin_gain != step.end_gain &&
        std::ranges::any_of(std::span(step.values).first(channels_),
                            [](const auto& value) { return value.begin_light != value.end_light; });
    const int parts = is_curved ? kChords : 1;
    for (int part = 0; part <= parts; ++part) {
      const double share = static_cast<double>(part) / parts;
      const double x =
          static_cast<double>(step.begin_ns) + share * static_cast<double>(step.end_ns - step.begin_ns);
      const double gain_here = std::lerp(step.begin_gain, step.end_gain, share);
      gain.push_back({x, gain_here});
      double sum = 0.0;
      for (std::uint32_t channel = 0; channel < channels_; ++channel) {
        const TraceStep::Value& value = step.values[channel];
        const double light_here = std::lerp(value.begin_light, value.end_light, share);
        light[channel].push_back({x, light_here});
        product[channel].push_back({x, light_here * gain_here});
        sum += light_here * gain_here;
      }
      mean_product.push_back({x, sum / channels_});
    }
  }

  std::uint32_t channels_;
};

plot::Extent extent_of(std::span<const std::vector<Point>> lines) {
  double low = 0.0, high = 0.0;
  for (const auto& line : lines) {
    for (const Point& point : line) {
      low = std::min(low, point.y);
      high = std::max(high, point.y);
    }
  }
  return plot::extent_with_zero(low, high);
}

// As large as fits, without its beginning where it would be too small: of a long path that says least.
void draw_heading(plot::Canvas& canvas, std::string heading) {
  constexpr double kLargest = 16, kMin = 10;
  const double room = kWidth - kLeft - kRight;
  plot::TextStyle style{.size = kLargest, .bold = true};
  style.size = std::max(kMin, std::min(kLargest, kLargest * room / canvas.text_width(heading, style)));
  if (canvas.text_width(heading, style) > room) {
    while (!heading.empty() && canvas.text_width("…" + heading, style) > room) {
      heading.erase(0, 1);
      while (!heading.empty() && (static_cast<unsigned char>(heading[0]) & 0xC0) == 0x80) heading.erase(0, 1);
    }
    heading.insert(0, "…");
  }
  canvas.text({kLeft, 30}, heading, style);
}

// `red green blue`, each in its colour, at the right above a graph.
void draw_legend(plot::Canvas& canvas, const plot::Box& box, const Trace& trace) {
  double right = box.right();
  for (std::uint32_t channel = trace.channels; channel-- > 0;) {
    const std::string name = channel_name(trace.channels, channel);
    const plot::TextStyle style{.size = 12, .colour = plot::kNote, .align = plot::Align::right};
    canvas.text({right, box.y - 7}, name, style);
    right -= canvas.text_width(name, style) + 5;
    canvas.line(std::array{Point{right - 22, box.y - 11}, Point{right, box.y - 11}},
                {.colour = channel_colour(trace, channel), .width = 2.5});
    right -= 38;
  }
}

}  // namespace

std::string light_text(std::span<const Trace> traces) {
  const std::array<double, 3> light = light_of(traces);
  std::string text;
  for (std::uint32_t channel = 0; channel < traces[0].channels; ++channel) {
    text += format("{}{:.6g}", channel == 0 ? "" : "  ", light[channel]);
  }
  return text;
}

std::string traced_codes(std::span<const Trace> traces, const CaptureFormat& capture,
                         const OutputFormat& output) {
  Picture light({1, 1, traces[0].channels}, ValueType::light64, output.white_code);
  std::copy_n(light_of(traces).begin(), traces[0].channels, light.values<double>().begin());
  const CodeMaking making = CodeMaking::of(capture, output);
  to_shown_light(light, making);
  const CodeScale scale(making.transfer, output);
  std::string text;
  for (const double value : light.values<double>()) {
    text += format("{}{}", text.empty() ? "" : " ", scale.code_of(value));
  }
  return text;
}

Picture trace_picture(const Trace& trace, const PlannedFunction& function, const std::string& heading) {
  const Interval range = shown_range(trace, function);
  const Lines lines(trace, range);
  const GainSummary& summary = function.summary;
  plot::Canvas canvas(kWidth, kHeight);
  draw_heading(canvas, heading);

  const plot::Extent time{static_cast<double>(range.begin_ns), static_cast<double>(range.end_ns)};
  const plot::Ticks time_ticks = plot::time_ticks(range.begin_ns, range.end_ns, kTimeTicks);
  double top = kTop;
  const auto open_graph = [&](const plot::Extent& extent, const char* name, const char* axis, bool is_last) {
    const plot::Box box{kLeft, top, kWidth - kLeft - kRight, kGraphHeight};
    top += kGraphHeight + kBetween;
    plot::Graph graph(canvas, box, time, extent);
    const plot::Ticks ticks = plot::number_ticks(extent.low, extent.high, kValueTicks);
    graph.grid(time_ticks, ticks);
    graph.heading(name);
    graph.y_axis(ticks, axis);
    if (is_last) graph.x_axis(time_ticks, format("time in the capture ({})", time_ticks.unit));
    return graph;
  };

  const std::span<const std::vector<plot::Point>> light(lines.light.data(), trace.channels);
  plot::Graph light_graph =
      open_graph(extent_of(light), trace.pixel_count == 1 ? "light of the pixel" : "mean light of the region",
                 "light (white = 1)", false);
  for (std::uint32_t channel = 0; channel < trace.channels; ++channel) {
    light_graph.line(light[channel], {.colour = channel_colour(trace, channel), .width = 1.5});
  }
  light_graph.frame();
  if (trace.channels > 1) draw_legend(canvas, light_graph.box(), trace);

  plot::Graph gain_graph = open_graph(extent_of({&lines.gain, 1}), "gain", "gain", false);
  gain_graph.area(lines.gain, plot::kPositiveArea, plot::kNegativeArea);
  gain_graph.line(lines.gain, {.colour = plot::kText, .width = 1.5});
  gain_graph.frame();
  gain_graph.note(
      format("D {}, ∫g {}, still gain {:.6g}", integral_text(static_cast<double>(summary.support_ns)),
             integral_text(std::scalbn(summary.integral_ns, summary.exponent)), summary.still_gain()));

  const std::span<const std::vector<plot::Point>> product(lines.product.data(), trace.channels);
  plot::Graph product_graph = open_graph(
      extent_of(product), trace.channels == 1 ? "light × gain" : "light × gain, shaded: mean of channels",
      "light × gain", true);
  product_graph.area(lines.mean_product, plot::kPositiveArea, plot::kNegativeArea);
  for (std::uint32_t channel = 0; channel < trace.channels; ++channel) {
    product_graph.line(product[channel], {.colour = channel_colour(trace, channel), .width = 1.2});
  }
  product_graph.frame();
  product_graph.note(format("∫ light × gain / D = {}", light_text({&trace, 1})));
  return canvas.finished();
}

Picture stacked(std::span<const Picture> pictures) {
  Picture all = pictures.front();
  for (const Picture& picture : pictures.subspan(1)) {
    all.bytes.insert(all.bytes.end(), picture.bytes.begin(), picture.bytes.end());
    all.shape.height += picture.shape.height;
  }
  return all;
}

}  // namespace nutik
