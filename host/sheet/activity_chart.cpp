#include "sheet/drawings.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "capture/transfer.hpp"
#include "plot/graph.hpp"

namespace nutik::sheet {
namespace {

constexpr std::uint32_t kWidth = 1200;
constexpr std::uint32_t kHeight = 420;
constexpr plot::Box kBox{80, 50, kWidth - 80 - 30, kHeight - 50 - 64};
constexpr plot::Colour kBusy = plot::Colour::of(0xd55e00, 0.18);
constexpr plot::Colour kQuiet = plot::Colour::of(0x009e73, 0.25);

void mark(plot::Canvas& canvas, plot::Graph& graph, const Timeline& timeline, const SampleRange& samples,
          plot::Colour colour, const char* name) {
  const auto from = static_cast<double>(timeline.start_ns(samples.first));
  const auto until = static_cast<double>(timeline.reach_end_ns(samples.last - 1));
  graph.band(from, until, colour);
  const double middle = graph.place({(from + until) / 2, 0}).x;
  const double half = canvas.text_width(name) / 2;
  canvas.text({std::clamp(middle, kBox.x + half, kBox.right() - half), kBox.y + 4}, name,
              {.align = plot::Align::centre, .rise = plot::Rise::top});
}

// A step for each sample, or for each run of them where they are many: its largest share, in percent.
std::vector<plot::Point> steps_of(const Timeline& timeline, std::span<const std::uint64_t> changed_pixels,
                                  std::uint64_t pixel_count) {
  const auto max_steps = static_cast<std::uint64_t>(2 * kBox.width);
  const std::uint64_t run = (changed_pixels.size() + max_steps - 1) / max_steps;
  std::vector<plot::Point> steps;
  for (std::uint64_t first = 0; first < changed_pixels.size(); first += run) {
    const std::uint64_t last = std::min<std::uint64_t>(first + run, changed_pixels.size());
    const std::uint64_t most = *std::ranges::max_element(changed_pixels.subspan(first, last - first));
    const double percent = 100.0 * static_cast<double>(most) / static_cast<double>(pixel_count);
    steps.push_back({static_cast<double>(timeline.start_ns(first)), percent});
    steps.push_back({static_cast<double>(timeline.reach_end_ns(last - 1)), percent});
  }
  return steps;
}

}  // namespace

Picture activity_map(const Shape& shape, std::span<const std::uint64_t> changes) {
  Picture map({shape.width, shape.height, 1}, ValueType::code8, 255);
  const double most = static_cast<double>(std::max<std::uint64_t>(*std::ranges::max_element(changes), 1));
  const Transfer srgb = Transfer::srgb();
  map.transfer = srgb;
  std::ranges::transform(changes, map.values<std::uint8_t>().begin(), [&](std::uint64_t count) {
    return static_cast<std::uint8_t>(std::lround(255 * srgb.fraction_of(static_cast<double>(count) / most)));
  });
  return map;
}

Picture activity_chart(const std::string& heading, const Timeline& timeline,
                       std::span<const std::uint64_t> changed_pixels, std::uint64_t pixel_count,
                       const std::optional<ActivityMoments>& moments) {
  plot::Canvas canvas(kWidth, kHeight);
  const std::int64_t end_ns = timeline.duration_ns();
  const std::vector<plot::Point> steps = steps_of(timeline, changed_pixels, pixel_count);
  const double most = std::ranges::max_element(steps, {}, &plot::Point::y)->y;
  // Room above the curve for the names of what is marked.
  const plot::Extent percent{0.0, most > 0.0 ? 1.18 * most : 1.0};
  plot::Graph graph(canvas, kBox, {0.0, static_cast<double>(end_ns)}, percent);
  const plot::Ticks times = plot::time_ticks(0, end_ns, 12);
  const plot::Ticks shares = plot::number_ticks(percent.low, percent.high, 8);
  graph.grid(times, shares);
  if (moments) {
    mark(canvas, graph, timeline, moments->quietest.samples, kQuiet, "quietest");
    mark(canvas, graph, timeline, moments->busiest.samples, kBusy, "busiest");
  }
  graph.area(steps, plot::kPositiveArea, plot::kPositiveArea);
  graph.line(steps, {.colour = plot::kPositive});
  graph.frame();
  graph.heading(heading);
  graph.x_axis(times, "time, " + times.unit);
  graph.y_axis(shares, "pixels that change, %");
  return canvas.finished();
}

}  // namespace nutik::sheet
