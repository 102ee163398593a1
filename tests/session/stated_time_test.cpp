#include "session/requests/stated_moments.hpp"

#include <gtest/gtest.h>

#include "capture/error.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

StatedTime parsed_time(std::string_view text) { return StatedTime::parse(text, "start"); }

TEST(StatedTime, IsEqualToTheSameTimeInAnotherUnit) {
  EXPECT_EQ(parsed_time("0.4s"), parsed_time("400ms"));
  EXPECT_EQ(parsed_time("2/5s"), parsed_time("400000us"));
  EXPECT_EQ(parsed_time("0s"), parsed_time("0h"));
  EXPECT_EQ(parsed_time("1/3min"), parsed_time("20s"));
  EXPECT_EQ(parsed_time("3f"), StatedTime::of_pictures(3));
  EXPECT_NE(parsed_time("0.4s"), parsed_time("401ms"));
  EXPECT_NE(parsed_time("0s"), parsed_time("0f")) << "what pictures come to depends on the timeline";
}

TEST(StatedTime, IsReadAsPeopleWriteIt) {
  EXPECT_EQ(parsed_time("0:01.5"), parsed_time("1500ms"));
  EXPECT_EQ(parsed_time("-1:02:03.25"), parsed_time("-3723.25s"));
  EXPECT_EQ(parsed_time("90:00"), parsed_time("1.5h"));
  EXPECT_EQ(parsed_time("1/100"), parsed_time("10ms"));
  EXPECT_EQ(parsed_time("+1s"), parsed_time("1e3ms"));
  for (const char* none : {"", "s", "5", "0.4", "1:2", "1:60", "1:02:60", ":01", "1:02:03:04", "0:1.5", "1 s", "--1s",
                           "+-1s", "1/0s", "0:01s", "1:0a", "1:", "0:01:", "0:01.5e2", "f", "1/2/3s"}) {
    EXPECT_THROW(static_cast<void>(parsed_time(none)), UsageError) << none;
  }
}

TEST(StatedTime, IsCompared128BitsWide) {
  EXPECT_NE(parsed_time("999999999999999/7ns"), parsed_time("999999999999998/7ns"));
  EXPECT_NE(parsed_time("999999999999999/999999999999998h"), parsed_time("999999999999998/999999999999997h"));
}

TEST(StatedTime, IsWrittenAsItWasStated) {
  for (const char* text : {"0.4s", "10ms", "250us", "37f", "-2s", "3h"}) EXPECT_EQ(parsed_time(text).text(), text);
  EXPECT_EQ(parsed_time("0.40s").text(), "0.4s");
  EXPECT_EQ(StatedTime::of_nanoseconds(400'000'000).text(), "400ms");
  EXPECT_EQ(StatedTime::of_nanoseconds(-2'000'000'000).text(), "-2s");
  EXPECT_EQ(StatedTime::of_nanoseconds(1'000'001).text(), "1000001ns");
  EXPECT_EQ(StatedTime::of_nanoseconds(0).text(), "0s");
}

TEST(StatedTime, OfLongCapturesIsReadAsItIsWritten) {
  for (const std::int64_t ns : {1'339'200'000'000'109, -1'339'200'000'000'109, 3'784'320'000'000'000'001}) {
    const StatedTime stated = StatedTime::of_nanoseconds(ns);
    EXPECT_EQ(parsed_time(stated.text()), stated) << ns;
    EXPECT_EQ(parsed_time(stated.text()).nanoseconds(), ns);
  }
  EXPECT_THROW(static_cast<void>(parsed_time("4000000000001000000ns")), UsageError);
  EXPECT_THROW(static_cast<void>(parsed_time("99999999999999999999ns")), UsageError);
  EXPECT_THROW(static_cast<void>(parsed_time("1339200000000109.5ns")), UsageError);
}

TEST(StatedTime, CountsPicturesOnATimeline) {
  const Timeline timeline = Timeline::constant({100, 1}, {180, 1}, 10);  // 10 ms each, open for 5
  EXPECT_EQ(plain_interval(parsed_time("2f"), parsed_time("3f"), timeline), (Exposure{20'000'000, 45'000'000}));
  EXPECT_EQ(plain_interval(parsed_time("25ms"), parsed_time("3f"), timeline), (Exposure{25'000'000, 55'000'000}));
  EXPECT_EQ(sample_at(parsed_time("25ms"), "start", timeline), 2u);
  EXPECT_EQ(sample_at(parsed_time("0.1s"), "start", timeline), 9u) << "the end belongs to the last picture";
  EXPECT_THROW(static_cast<void>(sample_at(parsed_time("101ms"), "start", timeline)), UsageError);
  EXPECT_THROW(static_cast<void>(plain_interval(parsed_time("8f"), parsed_time("3f"), timeline)), UsageError);
}

TEST(StatedTime, EndsAreRoundedOnceFromTheSumOfStartAndLength) {
  const Timeline thousand = Timeline::constant({1000, 1}, {360, 1}, 1000);
  EXPECT_EQ(plain_interval(parsed_time("1/300s"), parsed_time("1/300s"), thousand), (Exposure{3'333'333, 6'666'667}));
  const Timeline timeline = Timeline::constant({300, 1}, {180, 1}, 300);  // a third of 10 ms each
  EXPECT_EQ(plain_interval(parsed_time("1f"), parsed_time("1/300s"), timeline), (Exposure{3'333'333, 6'666'667}));
  EXPECT_EQ(plain_interval(parsed_time("1/300s"), parsed_time("1f"), timeline), (Exposure{3'333'333, 6'666'667}));
  Random random(3);
  const Timeline hour = Timeline::constant({1, 1}, {360, 1}, 3600);
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t a = random.whole(0, 100'000), b = random.whole(1, 100'000),
                       c = random.whole(1, 100'000), d = random.whole(1, 100'000);
    const StatedTime start{Rational::of(a, b), 1'000'000}, length{Rational::of(c, d), 1'000'000};
    const int128 end = (static_cast<int128>(a) * d + static_cast<int128>(c) * b) * 1'000'000;
    ASSERT_EQ(plain_interval(start, length, hour).end_ns, round_half_up(end, static_cast<int128>(b) * d))
        << start.text() << " for " << length.text();
  }
}

TEST(StatedTime, OfAnExactOneIsExactWhereDigitsHoldIt) {
  EXPECT_EQ(StatedTime::of({40'000'000, 1}).text(), "40ms");
  EXPECT_EQ(StatedTime::of(ExactTime{10'000'000, 3}).text(), "1/300s");
  EXPECT_EQ(StatedTime::of(ExactTime{10'000'000, 3} + ExactTime{10'000'000, 3}).text(), "1/150s");
  EXPECT_EQ(StatedTime::of(ExactTime{1, 999'999'999'999'989}).text(), "1/999999999999989ns");
  EXPECT_EQ(StatedTime::of(ExactTime{1'000'000'000'000'000, 3}).text(), "1000000/3s");
  EXPECT_EQ(StatedTime::of(ExactTime{1'000'000'000'000'001, 3}).text(), "333333333333334ns") << "rounded";
}

}  // namespace
}  // namespace nutik::test
