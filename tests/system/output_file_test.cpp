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

// A file system that takes a name takes no longer one for the time until it is whole.
TEST(OutputFile, MayHaveTheLongestName) {
  const Scratch scratch;
  const auto temporary_of = [&](const std::string& name) {
    OutputFile file(scratch / name);
    file.write("new");
    std::string temporary = file.temporary_path().filename();
    file.commit();
    EXPECT_EQ(test::read_file(scratch / name), "new");
    return temporary;
  };
  constexpr std::size_t kLongest = 255, kUnshortened = kLongest - std::string_view("..nutik.part").size();
  for (const std::size_t length : {kUnshortened - 1, kUnshortened, kUnshortened + 1, kLongest}) {
    const std::string name = std::string(length - 4, 'n') + ".tik";
    const std::string temporary = temporary_of(name);
    EXPECT_EQ(temporary == "." + name + ".nutik.part", length <= kUnshortened) << temporary;
    EXPECT_LE(temporary.size(), kLongest);
    EXPECT_TRUE(temporary.ends_with(".nutik.part")) << temporary;
    EXPECT_EQ(temporary_of(name), temporary) << "the next run knows it again";
  }
  const std::string alike(kLongest - 5, 'n');
  OutputFile first(scratch / (alike + "1.tik"));
  OutputFile other(scratch / (alike + "2.tik"));
  OutputFile another(scratch / (alike + "1.tik"));  // beside the first
  const std::string first_name = first.temporary_path().filename(),
                    other_name = other.temporary_path().filename();
  EXPECT_NE(first_name, other_name);
  EXPECT_TRUE(other_name.ends_with(".nutik.part")) << other_name;
  EXPECT_TRUE(another.temporary_path().string().ends_with(".nutik-1.part")) << another.temporary_path();
}

// Letters of several bytes are left out whole.
TEST(OutputFile, CutsNoLetterOfALongName) {
  const Scratch scratch;
  for (const char* const start : {"", "n", "nn"}) {
    std::string name = start;
    while (name.size() + 3 <= 255) name += "\u20ac";
    const OutputFile file(scratch / name);
    const std::string temporary = file.temporary_path().filename();
    std::string_view left = temporary;
    const std::string expected_start = std::string(".") + start;
    ASSERT_TRUE(left.starts_with(expected_start));
    left.remove_prefix(expected_start.size());
    while (left.starts_with("\u20ac")) left.remove_prefix(3);
    EXPECT_TRUE(left.starts_with("-")) << temporary;
  }
}

TEST(OutputFile, RefusesANameThatIsTooLongBeforeAllIsWritten) {
  const Scratch scratch;
  EXPECT_THROW(OutputFile(scratch / std::string(256, 'n')), OutputError);
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
