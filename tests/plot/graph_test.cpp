// Marks on axes: round numbers, as many as asked for, in units that fit.
// What is drawn lies where its numbers say, in its colour.
#include "plot/graph.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "capture/error.hpp"
#include "support/random_case.hpp"

namespace nutik::plot {
namespace {

std::string labels(const Ticks& ticks) {
  std::string text;
  for (const Tick& tick : ticks.ticks) text += tick.label + " ";
  return text + ticks.unit;
}

TEST(Ticks, TimesHaveTheUnitThatFits) {
  EXPECT_EQ(labels(time_ticks(0, 1'200'000'000, 6)), "0.0 0.2 0.4 0.6 0.8 1.0 1.2 s");
  EXPECT_EQ(labels(time_ticks(399'000'000, 411'000'000, 6)), "400 402 404 406 408 410 ms");
  EXPECT_EQ(labels(time_ticks(0, 9, 5)), "0 2 4 6 8 ns");
  EXPECT_EQ(labels(time_ticks(0, 1, 5)), "0 1 ns");
  EXPECT_EQ(labels(time_ticks(0, 45'000, 5)), "0 10 20 30 40 µs");
  EXPECT_EQ(labels(time_ticks(-3'000'000, 3'000'000, 3)), "-2 0 2 ms");
  EXPECT_EQ(labels(time_ticks(0, 7'200'000'000'000, 4)), "0 2000 4000 6000 s");
  // A moment far from 0: the digits that tell the marks apart are there.
  EXPECT_EQ(labels(time_ticks(1'000'000'000, 1'000'000'004, 4)),
            "1000000.000 1000000.001 1000000.002 1000000.003 1000000.004 µs");
}

TEST(Ticks, Numbers) {
  EXPECT_EQ(labels(number_ticks(0, 1, 5)), "0.0 0.2 0.4 0.6 0.8 1.0 ");
  EXPECT_EQ(labels(number_ticks(-26, 1.5, 6)), "-25 -20 -15 -10 -5 0 ");
  EXPECT_EQ(labels(number_ticks(-0.5, 1, 3)), "-0.5 0.0 0.5 1.0 ");
  EXPECT_EQ(labels(number_ticks(0, 2e30, 2)), "0 1e+30 2e+30 ");
  EXPECT_EQ(labels(number_ticks(0, 0.0004, 4)), "0.0000 0.0001 0.0002 0.0003 0.0004 ");
}

TEST(Ticks, AreFewAndWithinAndDifferent) {
  test::Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const int most = static_cast<int>(random.whole(2, 12));
    const std::int64_t begin = random.whole(-1'000'000'000'000, 1'000'000'000'000);
    const std::int64_t end = begin + random.whole(1, random.chance(0.5) ? 1000 : 10'000'000'000);
    const Ticks times = time_ticks(begin, end, most);
    const Ticks numbers =
        number_ticks(static_cast<double>(begin) * 1e-6, static_cast<double>(end) * 1e-6, most);
    for (const Ticks* ticks : {&times, &numbers}) {
      SCOPED_TRACE(std::to_string(begin) + " … " + std::to_string(end) + ": " + labels(*ticks));
      EXPECT_LE(ticks->ticks.size(), static_cast<std::size_t>(most) + 1);
      std::set<std::string> different;
      for (const Tick& tick : ticks->ticks) different.insert(tick.label);
      EXPECT_EQ(different.size(), ticks->ticks.size());
    }
    for (const Tick& tick : times.ticks) {
      EXPECT_GE(tick.at, static_cast<double>(begin));
      EXPECT_LE(tick.at, static_cast<double>(end));
    }
  }
}

std::uint32_t rgb_at(const Picture& picture, std::uint32_t x, std::uint32_t y) {
  const auto codes =
      picture.values<std::uint8_t>().subspan((std::uint64_t{y} * picture.shape.width + x) * 3, 3);
  return static_cast<std::uint32_t>(codes[0] << 16 | codes[1] << 8 | codes[2]);
}

// Pixels that are not of the background.
std::uint64_t marked(const Picture& picture) {
  std::uint64_t count = 0;
  for (std::uint32_t y = 0; y < picture.shape.height; ++y) {
    for (std::uint32_t x = 0; x < picture.shape.width; ++x) count += rgb_at(picture, x, y) != 0xffffff;
  }
  return count;
}

TEST(Canvas, FillsWholePixels) {
  Canvas canvas(20, 10);
  canvas.fill(Box{3, 2, 5, 4}, Colour::of(0x123456));
  const Picture picture = canvas.finished();
  EXPECT_EQ(picture.shape, (Shape{20, 10, 3}));
  EXPECT_EQ(rgb_at(picture, 3, 2), 0x123456u);
  EXPECT_EQ(rgb_at(picture, 7, 5), 0x123456u);
  EXPECT_EQ(marked(picture), 20u);
}

TEST(Canvas, ShowsAPictureWhereItWasPut) {
  Picture small({2, 1, 1}, ValueType::code8, 255);
  small.values<std::uint8_t>()[0] = 10;
  small.values<std::uint8_t>()[1] = 200;
  Canvas canvas(8, 4);
  canvas.picture(Box{2, 1, 2, 1}, small);
  const Picture picture = canvas.finished();
  EXPECT_EQ(rgb_at(picture, 2, 1), 0x0a0a0au);
  EXPECT_EQ(rgb_at(picture, 3, 1), 0xc8c8c8u);
  EXPECT_EQ(marked(picture), 2u);
}

TEST(Canvas, ClipsUntilTold) {
  Canvas canvas(10, 10);
  {
    const Canvas::Clip clip(canvas, Box{0, 0, 4, 10});
    canvas.fill(Box{0, 0, 10, 10}, kText);
  }
  EXPECT_EQ(marked(canvas.finished()), 40u);
  canvas.fill(Box{0, 0, 10, 10}, kText);
  EXPECT_EQ(marked(canvas.finished()), 100u);
}

TEST(Canvas, WritesText) {
  Canvas canvas(200, 40);
  const TextStyle style{.size = 20};
  EXPECT_GT(canvas.text_width("MMMM", style), 2 * canvas.text_width("MM", style) - 1);
  EXPECT_LT(canvas.text_width("ii", style), canvas.text_width("MM", style));
  canvas.text({100, 20}, "µs", style);
  EXPECT_GT(marked(canvas.finished()), 20u);
}

// Cairo takes no such text and then draws nothing any more.
TEST(Canvas, WritesBytesThatAreNoTextAsEscapesAndGoesOn) {
  const Box later{0, 40, 200, 20};
  for (const std::string_view text :
       {"caf\xe9.png", "\xed\xa0\x80", "a\xef\xbf\xbe", "\xf0\x9f\xbf\xbf", "a\nb"}) {
    Canvas canvas(200, 60);
    EXPECT_GT(canvas.text_width(text), canvas.text_width("a"));
    canvas.text({5, 20}, text);
    const std::size_t written = marked(canvas.finished());
    EXPECT_GT(written, 20u);
    canvas.fill(later, kText);
    EXPECT_EQ(marked(canvas.finished()), written + 200 * 20);
  }
  const Canvas canvas(10, 10);
  EXPECT_EQ(canvas.text_width("caf\xe9"), canvas.text_width("caf\\xe9"));
}

TEST(Canvas, RefusesASheetThatNoneCanBe) {
  EXPECT_THROW(Canvas(40'000, 10), UsageError);
  EXPECT_THROW(Canvas(0, 10), UsageError);
}

TEST(Graph, PlacesValues) {
  Canvas canvas(100, 60);
  const Graph graph(canvas, Box{10, 5, 80, 40}, {0, 8}, {-1, 1});
  EXPECT_EQ(graph.place({0, -1}).x, 10);
  EXPECT_EQ(graph.place({0, -1}).y, 45);
  EXPECT_EQ(graph.place({8, 1}).x, 90);
  EXPECT_EQ(graph.place({2, 0}).y, 25);
}

TEST(Graph, AreasHaveAColourOnEachSideOfZero) {
  Canvas canvas(100, 60);
  Graph graph(canvas, Box{10, 10, 80, 40}, {0, 2}, {-1, 1});
  graph.area(std::array{Point{0, 1}, Point{1, 1}, Point{1, -5}, Point{2, -5}}, kPositive,
             Colour::of(0xc85000));
  const Picture picture = canvas.finished();
  EXPECT_EQ(rgb_at(picture, 20, 20), 0x0060a8u);
  EXPECT_EQ(rgb_at(picture, 70, 40), 0xc85000u);
  EXPECT_EQ(rgb_at(picture, 20, 40), 0xffffffu);
  EXPECT_EQ(rgb_at(picture, 70, 20), 0xffffffu);
  EXPECT_EQ(rgb_at(picture, 70, 55), 0xffffffu);  // cut at the box
}

TEST(Graph, AnAxisHasZeroAndIsNeverEmpty) {
  for (const auto& [low, high] : {std::pair{0.0, 0.0}, {3.0, 5.0}, {-5.0, -3.0}, {-1.0, 2.0}}) {
    const Extent extent = extent_with_zero(low, high);
    EXPECT_LT(extent.low, extent.high);
    EXPECT_LE(extent.low, std::min(low, 0.0));
    EXPECT_GE(extent.high, std::max(high, 0.0));
  }
  // A twentieth of room where the values end, none behind zero.
  EXPECT_DOUBLE_EQ(extent_with_zero(3, 5).high, 5.25);
  EXPECT_EQ(extent_with_zero(3, 5).low, 0);
  EXPECT_DOUBLE_EQ(extent_with_zero(-1, 2).low, -1.15);
  EXPECT_DOUBLE_EQ(extent_with_zero(-1, 2).high, 2.15);
}

}  // namespace
}  // namespace nutik::plot
