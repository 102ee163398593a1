// Temporary captures: nothing is left of them, and nothing of anybody else is touched.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>

#include "imev/block_builder.hpp"
#include "session/clips/clip_reading.hpp"
#include "session/made_clip.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

class ScratchCaptures : public testing::Test {
 protected:
  ScratchCaptures() {
    const char* const before = std::getenv("TMPDIR");
    if (before != nullptr) before_ = before;
    ::setenv("TMPDIR", scratch_.folder().c_str(), 1);
  }
  ~ScratchCaptures() override {
    if (before_) {
      ::setenv("TMPDIR", before_->c_str(), 1);
    } else {
      ::unsetenv("TMPDIR");
    }
  }

  static ScratchCapture make() {
    return encode_to_scratch(
        {.path = "clip"}, [] { return std::make_unique<MadeClip>(7, 7); }, MemoryBudget::of_machine(),
        [](const CaptureFormat&) { return MemoryNeeds(); });
  }
  // With a file, as programs of earlier versions left one that were killed; `age` ago.
  fs::path leave(const std::string& name, std::chrono::seconds age) const {
    fs::create_directory(scratch_ / name);
    scratch_.write(name + "/capture.tik", "half of one");
    fs::last_write_time(scratch_ / name, fs::file_time_type::clock::now() - age);
    return scratch_ / name;
  }

  Scratch scratch_;

 private:
  std::optional<std::string> before_;
};

TEST_F(ScratchCaptures, HaveNoName) {
  const ScratchCapture made = make();
  EXPECT_EQ(made.reader->timeline().sample_count(), 7u);
  EXPECT_TRUE(fs::is_empty(scratch_.folder()));
}

// So that a picture of a kept clip has the bits of one that is exposed while the clip is read.
TEST_F(ScratchCaptures, HaveTheBlocksOfAStreamWhateverTheyHold) {
  struct StillClip final : MadeClip {
    using MadeClip::MadeClip;
    bool read(std::span<std::byte> raster) override {
      const bool has_read = MadeClip::read(raster);
      std::ranges::fill(raster, std::byte{7});
      return has_read;
    }
  };
  const Shape shape{4096, 2048, 1};
  const ScratchCapture made = encode_to_scratch(
      {.path = "clip"}, [&] { return std::make_unique<StillClip>(20, 20, shape); }, MemoryBudget::of_machine(),
      [](const CaptureFormat&) { return MemoryNeeds(); });
  EXPECT_EQ(made.reader->block_extent(0).sample_count, default_block_samples(made.reader->format()));
  EXPECT_EQ(made.reader->block_count(), 2u);
}

TEST_F(ScratchCaptures, LeaveNothingWhereAProcessIsKilledWhileItReads) {
  const pid_t child = fork();
  if (child == 0) {
    const auto killed = [](std::uint64_t samples, std::uint64_t) {
      if (samples > 0) kill(getpid(), SIGKILL);
    };
    const ScratchCapture made = encode_to_scratch(
        {.path = "clip"}, [] { return std::make_unique<MadeClip>(70, 7); }, MemoryBudget::of_machine(),
        [](const CaptureFormat&) { return MemoryNeeds(); }, killed);
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_TRUE(fs::is_empty(scratch_.folder()));
}

// A name proves nothing, however old a folder is.
TEST_F(ScratchCaptures, LeaveFoldersAloneThatHaveANameOfThisProgram) {
  const auto left = leave("nutik-Ab3xYz", 2min), old = leave("nutik-abcdef", 24h),
             other = leave("kept", 2min);
  scratch_.write("nutik-a_file", "precious");
  fs::create_directory_symlink(other, scratch_ / "nutik-a_link");
  make();
  for (const fs::path& folder : {left, old, other}) EXPECT_EQ(read_file(folder / "capture.tik"), "half of one");
  EXPECT_TRUE(fs::is_symlink(scratch_ / "nutik-a_link"));
  EXPECT_EQ(read_file(scratch_ / "nutik-a_file"), "precious");
}

}  // namespace
}  // namespace nutik::test
