// Encoding goes on beside exposing, and errors of either side reach the other.
#include "media/frame_queue.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <semaphore>

#include "capture/error.hpp"

namespace nutik {
namespace {

using namespace std::chrono_literals;

// Refuses a frame of the white code 99, and keeps the order of the others' white codes.
class KeepingWriter final : public VideoWriter {
 public:
  KeepingWriter(std::vector<std::uint32_t>& written, bool& is_finished)
      : written_(written), is_finished_(is_finished) {}
  void write(const Picture& picture, const std::string&, std::uint64_t) override {
    if (picture.white_code == 99) throw OutputError("the disk is full");
    written_.push_back(picture.white_code);
  }
  void finish() override { is_finished_ = true; }

 private:
  std::vector<std::uint32_t>& written_;
  bool& is_finished_;
};

Picture frame(std::uint32_t number) { return {{1, 1, 1}, ValueType::code8, number}; }

// Takes a frame only when the one after it has been made.
class FollowingWriter final : public VideoWriter {
 public:
  FollowingWriter(std::counting_semaphore<>& made, std::vector<std::uint32_t>& written)
      : made_(made), written_(written) {}
  void write(const Picture& picture, const std::string&, std::uint64_t) override {
    if (!made_.try_acquire_for(20s)) throw OutputError("nothing was made meanwhile");
    written_.push_back(picture.white_code);
  }
  void finish() override {}

 private:
  std::counting_semaphore<>& made_;
  std::vector<std::uint32_t>& written_;
};

TEST(FrameQueue, WritesAFrameWhileTheNextOnesAreMade) {
  constexpr std::uint32_t kFrames = 40;
  std::counting_semaphore<> made(0);
  std::vector<std::uint32_t> written;
  FrameQueue queue([&] { return std::make_unique<FollowingWriter>(made, written); });
  for (std::uint32_t k = 0; k < kFrames; ++k) {
    ASSERT_TRUE(queue.push(frame(k)));
    if (k > 0) made.release();
  }
  made.release();
  queue.finish();
  ASSERT_EQ(written.size(), kFrames);
  for (std::uint32_t k = 0; k < kFrames; ++k) EXPECT_EQ(written[k], k);
}

TEST(FrameQueue, TellsThatWritingFailed) {
  std::vector<std::uint32_t> written;
  bool is_finished = false;
  FrameQueue queue([&] { return std::make_unique<KeepingWriter>(written, is_finished); });
  std::uint32_t pushed = 0;
  while (queue.push(frame(pushed < 3 ? pushed : 99))) ++pushed;
  EXPECT_THROW(queue.finish(), OutputError);
  EXPECT_EQ(written, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_FALSE(is_finished);
  FrameQueue unopened([]() -> std::unique_ptr<VideoWriter> { throw OutputError("no such folder"); });
  while (unopened.push(frame(0))) {
  }
  EXPECT_THROW(unopened.finish(), OutputError);
}

// Its thread has ended by then: nothing is written to a writer, or by one, that is gone.
TEST(FrameQueue, WithoutFinishTheVideoIsDropped) {
  std::counting_semaphore<> may_open(0);
  std::vector<std::uint32_t> written;
  bool is_finished = false;
  {
    FrameQueue queue([&] {
      may_open.acquire();
      return std::make_unique<KeepingWriter>(written, is_finished);
    });
    for (std::uint32_t k = 0; k < 3; ++k) ASSERT_TRUE(queue.push(frame(k)));
    may_open.release();
  }
  EXPECT_EQ(written, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_FALSE(is_finished);
}

}  // namespace
}  // namespace nutik
