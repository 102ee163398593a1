#include "session/stated_time.hpp"

#include <gtest/gtest.h>

#include "capture/error.hpp"

namespace nutik {
namespace {

StatedTime time(std::string_view text) { return StatedTime::parse(text, "start"); }

TEST(StatedTime, IsEqualToTheSameTimeInAnotherUnit) {
  EXPECT_EQ(time("0.4s"), time("400ms"));
  EXPECT_EQ(time("2/5s"), time("400000us"));
  EXPECT_EQ(time("0s"), time("0h"));
  EXPECT_EQ(time("1/3min"), time("20s"));
  EXPECT_EQ(time("3f"), StatedTime::of_pictures(3));
  EXPECT_NE(time("0.4s"), time("401ms"));
  EXPECT_NE(time("0s"), time("0f")) << "what pictures come to depends on the timeline";
}

TEST(StatedTime, IsCompared128BitsWide) {
  EXPECT_NE(time("999999999999999/7ns"), time("999999999999998/7ns"));
  EXPECT_NE(time("999999999999999/999999999999998h"), time("999999999999998/999999999999997h"));
}

TEST(StatedTime, IsWrittenAsItWasStated) {
  for (const char* text : {"0.4s", "10ms", "250us", "37f", "-2s", "3h"}) EXPECT_EQ(time(text).text(), text);
  EXPECT_EQ(time("0.40s").text(), "0.4s");
  EXPECT_EQ(StatedTime::of_nanoseconds(400'000'000).text(), "400ms");
  EXPECT_EQ(StatedTime::of_nanoseconds(-2'000'000'000).text(), "-2s");
  EXPECT_EQ(StatedTime::of_nanoseconds(1'000'001).text(), "1000001ns");
  EXPECT_EQ(StatedTime::of_nanoseconds(0).text(), "0s");
}

TEST(StatedTime, CountsPicturesOnATimeline) {
  const Timeline timeline = Timeline::constant({100, 1}, {180, 1}, 10);  // 10 ms each, open for 5
  EXPECT_EQ(plain_interval(time("2f"), time("3f"), timeline), (Exposure{20'000'000, 45'000'000}));
  EXPECT_EQ(plain_interval(time("25ms"), time("3f"), timeline), (Exposure{25'000'000, 55'000'000}));
  EXPECT_EQ(sample_at(time("25ms"), "start", timeline), 2u);
  EXPECT_EQ(sample_at(time("0.1s"), "start", timeline), 9u) << "the end belongs to the last picture";
  EXPECT_THROW(static_cast<void>(sample_at(time("101ms"), "start", timeline)), UsageError);
  EXPECT_THROW(static_cast<void>(plain_interval(time("8f"), time("3f"), timeline)), UsageError);
}

}  // namespace
}  // namespace nutik
