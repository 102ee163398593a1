#include "system/output_file.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "capture/error.hpp"

#include "support/scratch.hpp"

namespace nutik {
namespace {

using test::Scratch;
namespace fs = std::filesystem;

// The temporary name can be foreseen: in a folder that all may write to, somebody may have put a link there.
TEST(OutputFile, WritesThroughNoLink) {
  const Scratch scratch;
  scratch.write("victim", "precious");
  const std::string name = ".a.nutik.part";
  fs::create_symlink("victim", scratch / name);
  OutputFile file(scratch / "a");
  file.write("new");
  file.commit();
  EXPECT_EQ(test::read_file(scratch / "victim"), "precious");
  EXPECT_EQ(test::read_file(scratch / "a"), "new");
  EXPECT_FALSE(fs::is_symlink(scratch / "a"));
  EXPECT_TRUE(fs::is_symlink(scratch / name));
}

// Of whoever is writing the same file at the same time: both are whole, and the later one stays.
TEST(OutputFile, LeavesAnothersTemporaryFileAlone) {
  const Scratch scratch;
  OutputFile first(scratch / "a");
  first.write("first, still being written");
  {
    OutputFile second(scratch / "a");
    EXPECT_NE(second.temporary_path(), first.temporary_path());
    second.write("second");
    second.commit();
  }
  EXPECT_EQ(test::read_file(scratch / "a"), "second");
  first.commit();
  EXPECT_EQ(test::read_file(scratch / "a"), "first, still being written");
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch.folder()), fs::directory_iterator()), 1);
}

TEST(OutputFile, TakesOverWhatAKilledProcessLeft) {
  const Scratch scratch;
  const pid_t child = fork();
  if (child == 0) {
    OutputFile file(scratch / "a");
    file.write("a long text of which nothing may be left");
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  ASSERT_TRUE(fs::exists(scratch / ".a.nutik.part"));
  {
    OutputFile file(scratch / "a");
    file.write("new");
    file.commit();
  }
  EXPECT_EQ(test::read_file(scratch / "a"), "new");
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch.folder()), fs::directory_iterator()), 1);
}

// A second name of a file that is none of ours to empty.
TEST(OutputFile, TakesOverNoHardLink) {
  const Scratch scratch;
  scratch.write("victim", "precious");
  fs::create_hard_link(scratch / "victim", scratch / ".a.nutik.part");
  OutputFile file(scratch / "a");
  file.write("new");
  file.commit();
  EXPECT_EQ(test::read_file(scratch / "victim"), "precious");
  EXPECT_EQ(test::read_file(scratch / "a"), "new");
}

TEST(OutputFile, WritesWhereALinkLeadsEvenToNothing) {
  const Scratch scratch;
  fs::create_directory(scratch / "there");
  for (const bool is_there : {false, true}) {
    fs::create_symlink("there/b", scratch / (is_there ? "full" : "dangling"));
    OutputFile file(scratch / (is_there ? "full" : "dangling"));
    file.write("new");
    file.commit();
    EXPECT_TRUE(fs::is_symlink(scratch / (is_there ? "full" : "dangling")));
    EXPECT_EQ(test::read_file(scratch / "there/b"), "new");
  }
  fs::create_symlink("two", scratch / "one");
  fs::create_symlink("one", scratch / "two");
  EXPECT_THROW(OutputFile(scratch / "one"), OutputError);
}

}  // namespace
}  // namespace nutik
