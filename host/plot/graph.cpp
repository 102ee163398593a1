#include "plot/graph.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <vector>

namespace nutik::plot {
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
