// Writing goes on beside exposing, and errors of either side reach the other.
#include "features/series/picture_queue.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <semaphore>

#include "capture/error.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

using namespace std::chrono_literals;
using Jobs = Channel<PictureJob>;

PictureJob job(std::uint64_t number) { return {.number = number, .picture = {{1, 1, 1}, ValueType::code8, 255}}; }

// Refuses the picture 99, and keeps the order of the others.
void keep(Jobs& jobs, std::vector<std::uint64_t>& written) {
  while (const auto next = jobs.pop()) {
    if (next->number == 99) throw OutputError("the disk is full");
    written.push_back(next->number);
  }
}

// A picture is taken only when the one after it has been made.
TEST(PictureQueue, WritesAPictureWhileTheNextOnesAreMade) {
  constexpr std::uint64_t kPictures = 40;
  std::counting_semaphore<> made(0);
  std::vector<std::uint64_t> written;
  const auto follow = [&](Jobs& jobs) {
    while (const auto next = jobs.pop()) {
      if (!made.try_acquire_for(20s)) throw OutputError("nothing was made meanwhile");
      written.push_back(next->number);
    }
  };
  PictureQueue queue(follow, 4);
  for (std::uint64_t k = 0; k < kPictures; ++k) {
    ASSERT_TRUE(queue.push(job(k)));
    if (k > 0) made.release();
  }
  made.release();
  queue.finish();
  ASSERT_EQ(written.size(), kPictures);
  for (std::uint64_t k = 0; k < kPictures; ++k) EXPECT_EQ(written[k], k);
}

// Pictures that nobody will write are exposed no further.
TEST(PictureQueue, TellsThatWritingFailed) {
  std::vector<std::uint64_t> written;
  PictureQueue queue([&](Jobs& jobs) { keep(jobs, written); });
  std::uint64_t pushed = 0;
  while (queue.push(job(pushed < 3 ? pushed : 99))) ++pushed;
  EXPECT_THROW(queue.finish(), OutputError);
  EXPECT_EQ(written, (std::vector<std::uint64_t>{0, 1, 2}));
  PictureQueue unopened([](Jobs&) { throw OutputError("no such folder"); });
  while (unopened.push(job(0))) {
  }
  EXPECT_THROW(unopened.finish(), OutputError);
}

// Its thread has ended by then: nothing is written by a writer that is gone.
TEST(PictureQueue, WithoutFinishWritesWhatWasPushed) {
  std::counting_semaphore<> may_open(0);
  std::vector<std::uint64_t> written;
  {
    const auto open = [&](Jobs& jobs) {
      may_open.acquire();
      keep(jobs, written);
    };
    PictureQueue queue(open, 4);
    for (std::uint64_t k = 0; k < 3; ++k) ASSERT_TRUE(queue.push(job(k)));
    may_open.release();
  }
  EXPECT_EQ(written, (std::vector<std::uint64_t>{0, 1, 2}));
}

TEST(PictureJob, IsKeptThoughASignalHasCome) {
  const Scratch scratch;
  for (const char* name : {"a.png", "b.tif"}) {
    PictureJob made = job(0);
    made.path = scratch / name;
    made.wishes.check = [] { throw Cancelled(); };
    made.write();
    EXPECT_TRUE(std::filesystem::exists(made.path)) << name;
  }
}

}  // namespace
}  // namespace nutik::test
