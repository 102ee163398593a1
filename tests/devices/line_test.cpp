// Pictures that are made at the same time come in the order in which they were asked for; what fails first is thrown.
#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <stdexcept>
#include <thread>

#include "capture/error.hpp"
#include "features/series/picture_queue.hpp"

namespace nutik {
namespace {

using Line = PictureLine<int>;

TEST(PictureLine, OfOneMakesAPictureWhenItIsTaken) {
  Line line(1);
  std::thread::id maker;
  line.add([&](const RenderControl& control) {
    maker = std::this_thread::get_id();
    return control.by_one_device ? 2 : 1;
  });
  EXPECT_TRUE(line.is_full());
  EXPECT_EQ(maker, std::thread::id());
  EXPECT_EQ(line.take(), 1);
  EXPECT_EQ(maker, std::this_thread::get_id());
  EXPECT_TRUE(line.is_empty());
}

// Each waits until all are there; the last one is finished first.
TEST(PictureLine, KeepsTheOrder) {
  constexpr int kLength = 4;
  Line line(kLength);
  std::latch there(kLength);
  std::atomic<int> finished{0};
  for (int k = 0; k < kLength; ++k) {
    line.add([&, k](const RenderControl& control) {
      EXPECT_TRUE(control.by_one_device);
      there.arrive_and_wait();
      while (finished != kLength - 1 - k) std::this_thread::yield();
      ++finished;
      return k;
    });
  }
  EXPECT_TRUE(line.is_full());
  for (int k = 0; k < kLength; ++k) EXPECT_EQ(line.take(), k);
}

// The third fails; the first two wait until they are stopped for it.
TEST(PictureLine, EndsWithWhatFailsFirst) {
  Line line(3);
  const auto wait = [](const RenderControl& control) -> int {
    while (!control.stop.stop_requested()) std::this_thread::yield();
    throw Cancelled();
  };
  line.add(wait);
  line.add(wait);
  line.add([](const RenderControl&) -> int { throw std::runtime_error("lost"); });
  for (int k = 0; k < 3; ++k) {
    try {
      static_cast<void>(line.take());
      FAIL();
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "lost");
    }
  }
}

TEST(PictureLine, StopsWhatNobodyTakes) {
  std::atomic<int> ended{0};
  {
    Line line(2);
    for (int k = 0; k < 2; ++k) {
      line.add([&](const RenderControl& control) {
        while (!control.stop.stop_requested()) std::this_thread::yield();
        return ++ended;
      });
    }
  }
  EXPECT_EQ(ended, 2);
}

}  // namespace
}  // namespace nutik
