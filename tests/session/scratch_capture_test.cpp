// Temporary captures, and what becomes of those that killed processes left.
#include "session/clips/scratch_capture.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>

#include "session/made_clip.hpp"
#include "support/scratch.hpp"

namespace nutik {
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
    SourceRequest source;
    source.path = "clip";
    return encode_to_scratch(
        source, [] { return std::make_unique<test::MadeClip>(7, 7); }, MemoryBudget::of_machine(),
        [](const CaptureFormat&) { return MemoryNeeds(); });
  }
  // With a file, as a process leaves it; `age` ago.
  fs::path leave(const std::string& name, std::chrono::seconds age) const {
    fs::create_directory(scratch_ / name);
    scratch_.write(name + "/capture.tik", "half of one");
    fs::last_write_time(scratch_ / name, fs::file_time_type::clock::now() - age);
    return scratch_ / name;
  }

  test::Scratch scratch_;

 private:
  std::optional<std::string> before_;
};

TEST_F(ScratchCaptures, HaveNoNameAnyMoreWhenTheyAreRead) {
  const ScratchCapture made = make();
  EXPECT_EQ(made.reader->timeline().sample_count(), 7u);
  EXPECT_TRUE(fs::is_empty(scratch_.folder()));
}

TEST_F(ScratchCaptures, RemoveWhatKilledProcessesLeft) {
  const auto left = leave("nutik-Ab3xYz", 2min), other = leave("nutik-000000", 24h);
  make();
  EXPECT_FALSE(fs::exists(left));
  EXPECT_FALSE(fs::exists(other));
}

// A folder is made first and locked then.
TEST_F(ScratchCaptures, LeaveNewFoldersAlone) {
  const auto left = leave("nutik-Ab3xYz", 30s);
  make();
  EXPECT_TRUE(fs::exists(left / "capture.tik"));
}

TEST_F(ScratchCaptures, LeaveFoldersOfProcessesThatLiveAlone) {
  const auto left = leave("nutik-Ab3xYz", 2min);
  const int lock = ::open(left.c_str(), O_RDONLY | O_DIRECTORY);
  ASSERT_EQ(::flock(lock, LOCK_EX | LOCK_NB), 0);
  make();
  EXPECT_TRUE(fs::exists(left / "capture.tik"));
  ::close(lock);
  make();
  EXPECT_FALSE(fs::exists(left));
}

TEST_F(ScratchCaptures, LeaveAllElseAlone) {
  const auto longer = leave("nutik-Ab3xYzw", 2min), others = leave("other-Ab3xYz", 2min),
             kept = leave("kept", 2min);
  scratch_.write("nutik-a_file", "precious");
  fs::create_directory_symlink(kept, scratch_ / "nutik-a_link");
  make();
  EXPECT_TRUE(fs::exists(longer / "capture.tik"));
  EXPECT_TRUE(fs::exists(others / "capture.tik"));
  EXPECT_TRUE(fs::exists(kept / "capture.tik"));
  EXPECT_TRUE(fs::is_symlink(scratch_ / "nutik-a_link"));
  EXPECT_EQ(test::read_file(scratch_ / "nutik-a_file"), "precious");
}

}  // namespace
}  // namespace nutik
