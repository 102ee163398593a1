#include "align/camera_path.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "capture/format.hpp"
#include "plot/graph.hpp"

namespace nutik {
namespace {

constexpr std::uint32_t kPathWidth = 1200, kPathHeight = 640;
constexpr plot::Box kMoved{80, 50, kPathWidth - 80 - 30, 300};
constexpr plot::Box kTurned{80, 400, kPathWidth - 80 - 30, 170};

// A course over the pictures' times.
struct Course {
  std::vector<plot::Point> points;
  plot::Colour colour;
};

void draw(plot::Canvas& canvas, const plot::Box& box, const Timeline& timeline,
          const std::vector<Course>& courses, std::string_view heading, std::string_view x_label,
          std::string_view y_label) {
  double low = 0, high = 0;
  for (const Course& course : courses) {
    for (const plot::Point& point : course.points) {
      low = std::min(low, point.y);
      high = std::max(high, point.y);
    }
  }
  const plot::Extent extent = plot::extent_with_zero(low, high);
  plot::Graph graph(canvas, box, {0.0, static_cast<double>(timeline.duration_ns())}, extent);
  const plot::Ticks times = plot::time_ticks(0, timeline.duration_ns(), 12);
  const plot::Ticks values = plot::number_ticks(extent.low, extent.high, 6);
  graph.grid(times, values);
  graph.frame();
  for (const Course& course : courses) graph.line(course.points, {.colour = course.colour, .width = 1.6});
  if (!heading.empty()) graph.heading(heading);
  graph.x_axis(times, x_label.empty() ? std::string() : format("{}, {}", x_label, times.unit));
  graph.y_axis(values, y_label);
}

}  // namespace

Picture camera_chart(const std::string& heading, const CameraPath& path, const Timeline& timeline) {
  plot::Canvas canvas(kPathWidth, kPathHeight);
  Course right{{}, plot::kPalette[0]}, down{{}, plot::kPalette[1]}, turned{{}, plot::kPalette[2]};
  for (std::uint64_t picture = 0; picture < path.pictures.size(); ++picture) {
    const auto time = static_cast<double>(timeline.start_ns(picture));
    const CameraPath::Step step = path.step(picture);
    right.points.push_back({time, step.x});
    down.points.push_back({time, step.y});
    turned.points.push_back({time, step.degrees});
  }
  draw(canvas, kMoved, timeline, {right, down}, heading, {}, "moved by, pixels");
  const double legend = kMoved.right();
  canvas.text({legend - 90, kMoved.y - 14}, "to the right",
              {.colour = right.colour, .align = plot::Align::right});
  canvas.text({legend, kMoved.y - 14}, "downwards", {.colour = down.colour, .align = plot::Align::right});
  draw(canvas, kTurned, timeline, {turned}, {}, "time", "turned by, degrees");
  return canvas.finished();
}

}  // namespace nutik
