// A capture that becomes shorter, or is written to, while it is exposed: an error with its name, and no output.
#include <gtest/gtest.h>

#include <fstream>

#include "support/program_test.hpp"
#include "support/running_program.hpp"

namespace nutik::test {
namespace {

namespace fs = std::filesystem;

struct LostFiles : ProgramTest, testing::WithParamInterface<const char*> {
  // Writes one block after the other, each of several pages and none packed: they are read where the system maps them.
  void SetUp() override {
    {
      std::ofstream noise(scratch_ / "clip.raw", std::ios::binary);
      std::uint32_t state = 1;
      for (int i = 0; i < 64 * 64 * 64; ++i)
        noise.put(static_cast<char>((state = state * 1664525 + 1013904223) >> 24));
    }
    const auto made = run({"--raw", "64x64:gray", "-f", "64", "--codec", "none", "--block-samples", "8", "--overwrite",
                           "clip.raw", "c.tik"});
    ASSERT_EQ(made.status, 0) << made.err;
  }
  [[nodiscard]] std::vector<std::string> long_video() const {
    return {"video", "--renderer", GetParam(), "--out-fps", "1000", "--speed", "0.02", "--overwrite", "c.tik", "v.mkv"};
  }
  void expect_refused(RunningProgram& running) const {
    EXPECT_EQ(running.end(), 3);
    const std::string log = read_file(scratch_ / "log");
    expect_says(log, "c.tik changed or could not be read any more while it was read");
    EXPECT_TRUE(files_with(scratch_.folder(), "v.mkv").empty());
  }
};

TEST_P(LostFiles, AreToldByNameWhenTheyAreCutOff) {
  for (const double share : {0.9, 0.5, 0.0}) {
    SetUp();
    RunningProgram running(long_video(), scratch_.folder());
    ASSERT_TRUE(running.reaches([&] { return has_begun_writing(scratch_.folder()); }));
    fs::resize_file(scratch_ / "c.tik", static_cast<std::uintmax_t>(
                                            share * static_cast<double>(fs::file_size(scratch_ / "c.tik"))));
    expect_refused(running);
  }
}

TEST_P(LostFiles, AreToldByNameWhenTheyAreWrittenTo) {
  // Codes; and what says where codes lie, which a kernel believes while it runs.
  std::vector<int> offsets{12'000};
  if (GetParam() == std::string("reference")) offsets.push_back(5000);
  for (const int offset : offsets) {
    SetUp();
    RunningProgram running(long_video(), scratch_.folder());
    ASSERT_TRUE(running.reaches([&] { return has_begun_writing(scratch_.folder()); }));
    std::fstream(scratch_ / "c.tik", std::ios::in | std::ios::out | std::ios::binary)
        .seekp(offset)
        .write("other", 5);
    expect_refused(running);
  }
}

TEST_P(LostFiles, MayBeReplaced) {
  RunningProgram running(
      {"video", "--renderer", GetParam(), "--out-fps", "1000", "--speed", "2", "c.tik", "v.mkv"},
      scratch_.folder());
  ASSERT_TRUE(running.reaches([&] { return has_begun_writing(scratch_.folder()); }));
  scratch_.write("new.tik", "another");
  fs::rename(scratch_ / "new.tik", scratch_ / "c.tik");
  EXPECT_EQ(running.end(), 0) << read_file(scratch_ / "log");
}

INSTANTIATE_TEST_SUITE_P(, LostFiles, testing::Values("reference", "opencl"),
                         [](const auto& renderer) { return std::string(renderer.param); });

}  // namespace
}  // namespace nutik::test
