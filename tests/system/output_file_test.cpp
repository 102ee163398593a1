#include "system/output_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "support/scratch.hpp"

namespace nutik {
namespace {

using test::Scratch;
namespace fs = std::filesystem;

// The temporary name can be foreseen: in a folder that all may write to, somebody may have put a link there.
TEST(OutputFile, WritesThroughNoLink) {
  const Scratch scratch;
  scratch.write("victim", "precious");
  const std::string name = ".a." + std::to_string(getpid()) + ".part";
  fs::create_symlink("victim", scratch / name);
  OutputFile file(scratch / "a");
  file.write("new");
  file.commit();
  EXPECT_EQ(test::read_file(scratch / "victim"), "precious");
  EXPECT_EQ(test::read_file(scratch / "a"), "new");
  EXPECT_FALSE(fs::is_symlink(scratch / "a"));
  EXPECT_TRUE(fs::is_symlink(scratch / name));
}

// A process of the same number that was killed leaves one behind.
TEST(OutputFile, LeavesAnothersTemporaryFileAlone) {
  const Scratch scratch;
  const auto left = scratch.write(".a." + std::to_string(getpid()) + ".part", "left behind");
  {
    OutputFile file(scratch / "a");
    file.write("new");
  }
  EXPECT_EQ(test::read_file(left), "left behind");
  EXPECT_FALSE(fs::exists(scratch / "a"));
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch.folder()), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace nutik
