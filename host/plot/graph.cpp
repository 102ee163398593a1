#include "plot/graph.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <vector>

#include "capture/format.hpp"

namespace nutik::plot {
namespace {

struct TimeUnit {
  const char* name;
  int decimals;  // of a nanosecond in it
};
constexpr std::array<TimeUnit, 4> kTimeUnits{{{"s", 9}, {"ms", 6}, {"µs", 3}, {"ns", 0}}};
constexpr int kMaxDecimals = 3;

// The least of 1, 2, 5 times a power of ten that is not below `least`.
struct RoundStep {
  double mantissa = 1.0;
  int exponent = 0;

  explicit RoundStep(double least) : exponent(static_cast<int>(std::floor(std::log10(least)))) {
    const double rest = least / std::pow(10.0, exponent);
    constexpr double kRounding = 1 + 1e-9;
    mantissa = rest <= kRounding ? 1.0 : rest <= 2 * kRounding ? 2.0 : rest <= 5 * kRounding ? 5.0 : 10.0;
    if (mantissa == 10.0) {
      mantissa = 1.0;
      ++exponent;
    }
  }
  [[nodiscard]] double value() const { return mantissa * std::pow(10.0, exponent); }
};

}  // namespace

Ticks time_ticks(std::int64_t begin_ns, std::int64_t end_ns, int most) {
  const auto span = static_cast<double>(end_ns - begin_ns);
  const RoundStep step(std::max(1.0, span / most));
  const auto step_ns = std::max<std::int64_t>(1, std::llround(step.value()));
  const std::int64_t largest_ns = std::max(std::abs(begin_ns), std::abs(end_ns));
  const auto fits = [&](const TimeUnit& unit) {
    return std::max(0, unit.decimals - step.exponent) <= kMaxDecimals &&
           static_cast<double>(largest_ns) >= std::pow(10.0, unit.decimals);
  };
  const auto found = std::find_if(kTimeUnits.begin(), kTimeUnits.end(), fits);
  const TimeUnit unit = found == kTimeUnits.end() ? kTimeUnits.back() : *found;
  const int decimals = std::max(0, unit.decimals - step.exponent);

  Ticks result{{}, unit.name};
  std::int64_t first = begin_ns / step_ns;
  if (first * step_ns < begin_ns) ++first;
  for (std::int64_t i = first; i * step_ns <= end_ns; ++i) {
    const auto at = static_cast<double>(i * step_ns);
    result.ticks.push_back({at, format("{:.{}f}", at / std::pow(10.0, unit.decimals), decimals)});
  }
  return result;
}

Ticks number_ticks(double low, double high, int most) {
  const RoundStep step((high - low) / most);
  const int decimals = std::max(0, -step.exponent);
  const double largest = std::max(std::fabs(low), std::fabs(high));
  const bool is_plain = largest < 1e6 && decimals <= 6;
  // Enough to tell neighbours apart.
  const int digits = 2 + static_cast<int>(std::max(0.0, std::log10(largest / step.value())));
  constexpr double kRounding = 1e-9;  // of a step: an end that is a round number gets its mark
  Ticks result;
  const double last = std::floor(high / step.value() + kRounding);
  for (double i = std::ceil(low / step.value() - kRounding); i <= last; ++i) {
    const double at = (i == 0 ? 0.0 : i) * step.value();  // never -0
    result.ticks.push_back({at, is_plain ? format("{:.{}f}", at, decimals) : format("{:.{}g}", at, digits)});
  }
  return result;
}

namespace {

constexpr double kTickLength = 4.0;
constexpr double kLabelGap = 4.0;
constexpr double kAxisLabelGap = 8.0;

// The middle of a pixel, where a line one pixel wide is sharp.
double sharp(double at) { return std::floor(at) + 0.5; }

}  // namespace

Extent extent_with_zero(double low, double high) {
  Extent extent{std::min(low, 0.0), std::max(high, 0.0)};
  if (extent.length() == 0.0) return {0.0, 1.0};
  const double room = 0.05 * extent.length();
  if (extent.low < 0.0) extent.low -= room;
  if (extent.high > 0.0) extent.high += room;
  return extent;
}

Graph::Graph(Canvas& canvas, const Box& box, Extent x, Extent y) : canvas_(canvas), box_(box), x_(x), y_(y) {}

void Graph::heading(std::string_view text) { canvas_.text({box_.x, box_.y - 7}, text, {.bold = true}); }

void Graph::note(std::string_view text) {
  canvas_.text({box_.right(), box_.y - 7}, text, {.size = 12, .colour = kNote, .align = Align::right});
}

void Graph::grid(const Ticks& x, const Ticks& y) {
  for (const Tick& tick : x.ticks) {
    const double at = sharp(place({tick.at, 0}).x);
    canvas_.line(std::array{Point{at, box_.y}, Point{at, box_.bottom()}}, {.colour = kGrid});
  }
  for (const Tick& tick : y.ticks) {
    const double at = sharp(place({0, tick.at}).y);
    canvas_.line(std::array{Point{box_.x, at}, Point{box_.right(), at}}, {.colour = kGrid});
  }
}

void Graph::x_axis(const Ticks& ticks, std::string_view label) {
  const TextStyle style{.size = 12, .align = Align::centre, .rise = Rise::top};
  for (const Tick& tick : ticks.ticks) {
    const double at = sharp(place({tick.at, 0}).x);
    canvas_.line(std::array{Point{at, box_.bottom()}, Point{at, box_.bottom() + kTickLength}}, {});
    canvas_.text({at, box_.bottom() + kTickLength + kLabelGap / 2}, tick.label, style);
  }
  if (label.empty()) return;
  canvas_.text({box_.x + box_.width / 2, box_.bottom() + kTickLength + 20}, label,
               {.align = Align::centre, .rise = Rise::top});
}

void Graph::y_axis(const Ticks& ticks, std::string_view label) {
  const TextStyle style{.size = 12, .align = Align::right, .rise = Rise::middle};
  double widest = 0.0;
  for (const Tick& tick : ticks.ticks) {
    const double at = sharp(place({0, tick.at}).y);
    canvas_.line(std::array{Point{box_.x - kTickLength, at}, Point{box_.x, at}}, {});
    canvas_.text({box_.x - kTickLength - kLabelGap, at}, tick.label, style);
    widest = std::max(widest, canvas_.text_width(tick.label, style));
  }
  if (label.empty()) return;
  canvas_.text({box_.x - kTickLength - kLabelGap - widest - kAxisLabelGap, box_.y + box_.height / 2}, label,
               {.align = Align::centre, .rise = Rise::bottom, .upwards = true});
}

void Graph::frame() {
  if (y_.low < 0.0 && y_.high > 0.0) {
    const double zero = sharp(place({0, 0}).y);
    canvas_.line(std::array{Point{box_.x, zero}, Point{box_.right(), zero}}, {.colour = kZeroLine});
  }
  canvas_.frame(box_, {.colour = kNote});
}

void Graph::line(std::span<const Point> values, const LineStyle& style) {
  const Canvas::Clip clip(canvas_, {box_.x, box_.y - 1, box_.width, box_.height + 2});
  std::vector<Point> points;
  points.reserve(values.size());
  std::ranges::transform(values, std::back_inserter(points),
                         [&](const Point& value) { return place(value); });
  canvas_.line(points, style);
}

void Graph::band(double from_x, double to_x, Colour colour) {
  const double left = std::clamp(place({from_x, 0}).x, box_.x, box_.right());
  const double right = std::clamp(place({to_x, 0}).x, box_.x, box_.right());
  if (left < right) canvas_.fill(Box{left, box_.y, right - left, box_.height}, colour);
}

void Graph::area(std::span<const Point> values, Colour above, Colour below) {
  if (values.empty()) return;
  std::vector<Point> polygon{place({values.front().x, 0})};
  for (const Point& value : values) polygon.push_back(place(value));
  polygon.push_back(place({values.back().x, 0}));
  const double zero = std::clamp(place({0, 0}).y, box_.y, box_.bottom());
  {
    const Canvas::Clip clip(canvas_, {box_.x, box_.y, box_.width, zero - box_.y});
    canvas_.fill(polygon, above);
  }
  const Canvas::Clip clip(canvas_, {box_.x, zero, box_.width, box_.bottom() - zero});
  canvas_.fill(polygon, below);
}

}  // namespace nutik::plot
