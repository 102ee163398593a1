// Encoding goes on beside exposing, and errors of either side reach the other.
#include "media/frame_queue.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "capture/error.hpp"

namespace nutik {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

// Takes a while for each frame, and keeps the order of their white codes.
class SlowWriter final : public VideoWriter {
 public:
  SlowWriter(std::chrono::milliseconds each, std::vector<std::uint32_t>& written, bool& is_finished)
      : each_(each), written_(written), is_finished_(is_finished) {}
  void write(const Picture& picture) override {
    std::this_thread::sleep_for(each_);
    if (picture.white_code == 99) throw OutputError("the disk is full");
    written_.push_back(picture.white_code);
  }
  void finish() override { is_finished_ = true; }

 private:
  std::chrono::milliseconds each_;
  std::vector<std::uint32_t>& written_;
  bool& is_finished_;
};

Picture frame(std::uint32_t number) { return {{1, 1, 1}, ValueType::code8, number}; }

TEST(FrameQueue, RunsAtFourFifthsOfTheSlowerSideOrMore) {
  for (const auto& [expose, encode] : {std::pair{12ms, 20ms}, std::pair{20ms, 12ms}, std::pair{15ms, 15ms}}) {
    constexpr std::uint32_t kFrames = 40;
    // How long the slower side takes alone, here and now: a busy machine wakes sleepers late.
    const auto alone_begin = Clock::now();
    for (std::uint32_t k = 0; k < kFrames; ++k) std::this_thread::sleep_for(std::max(expose, encode));
    const auto alone = Clock::now() - alone_begin;

    std::vector<std::uint32_t> written;
    bool is_finished = false;
    const auto begin = Clock::now();
    FrameQueue queue([&] { return std::make_unique<SlowWriter>(encode, written, is_finished); });
    for (std::uint32_t k = 0; k < kFrames; ++k) {
      std::this_thread::sleep_for(expose);
      ASSERT_TRUE(queue.push(frame(k)));
    }
    queue.finish();
    const std::chrono::duration<double> together = Clock::now() - begin;
    const double share = std::chrono::duration<double>(alone).count() / together.count();
    EXPECT_GE(share, 0.8);
    std::printf("exposing %lld ms, encoding %lld ms: %.3f of the slower alone\n",
                static_cast<long long>(expose.count()), static_cast<long long>(encode.count()), share);
    EXPECT_TRUE(is_finished);
    ASSERT_EQ(written.size(), kFrames);
    for (std::uint32_t k = 0; k < kFrames; ++k) EXPECT_EQ(written[k], k);
  }
}

TEST(FrameQueue, TellsThatWritingFailed) {
  std::vector<std::uint32_t> written;
  bool is_finished = false;
  FrameQueue queue([&] { return std::make_unique<SlowWriter>(1ms, written, is_finished); });
  std::uint32_t pushed = 0;
  while (queue.push(frame(pushed < 3 ? pushed : 99))) ++pushed;
  EXPECT_THROW(queue.finish(), OutputError);
  EXPECT_EQ(written.size(), 3u);
  EXPECT_FALSE(is_finished);
  FrameQueue unopened([]() -> std::unique_ptr<VideoWriter> { throw OutputError("no such folder"); });
  while (unopened.push(frame(0))) {
  }
  EXPECT_THROW(unopened.finish(), OutputError);
}

TEST(FrameQueue, WithoutFinishTheVideoIsDropped) {
  std::vector<std::uint32_t> written;
  bool is_finished = false;
  {
    FrameQueue queue([&] { return std::make_unique<SlowWriter>(1ms, written, is_finished); });
    ASSERT_TRUE(queue.push(frame(0)));
  }
  EXPECT_FALSE(is_finished);
}

}  // namespace
}  // namespace nutik
