// Marks on axes: round numbers, as many as asked for, in units that fit.
#include "plot/ticks.hpp"

#include <gtest/gtest.h>

#include <set>

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

}  // namespace
}  // namespace nutik::plot
