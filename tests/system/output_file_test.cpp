#include "system/output_file.hpp"
#include "support/messages.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "capture/error.hpp"

#include "support/running_program.hpp"
#include "support/scratch.hpp"
#include "system/linux_calls.hpp"
#include "system/temporary_folder.hpp"

namespace nutik::test {
namespace {

namespace fs = std::filesystem;

// Names of earlier versions and of this one: such a file is somebody else's, or can still be recovered.
TEST(OutputFile, LeavesFilesAloneThatAreCalledAsTemporaryFilesAre) {
  const Scratch scratch;
  scratch.write("victim", "precious");
  std::vector<std::string> names{".a.nutik.part", ".a.nutik-0123456789abcdef.part"};
  for (int tried = 1; tried < 120; ++tried) names.push_back(".a.nutik-" + std::to_string(tried) + ".part");
  for (const std::string& name : names) scratch.write(name, "half of one");
  fs::create_symlink("victim", scratch / ".a.nutik-120.part");
  fs::create_hard_link(scratch / "victim", scratch / ".a.nutik-121.part");
  OutputFile file(scratch / "a");
  file.write("new");
  file.commit();
  EXPECT_EQ(read_file(scratch / "a"), "new");
  EXPECT_EQ(read_file(scratch / "victim"), "precious");
  for (const std::string& name : names) EXPECT_EQ(read_file(scratch / name), "half of one");
  EXPECT_TRUE(fs::is_symlink(scratch / ".a.nutik-120.part"));
}

// Another process writes the same file at the same time: both are whole, and the later one stays. Unless nothing else
// was to be replaced but what was there: then the earlier one stays, and the later one beside it.
TEST(OutputFile, LeavesAnothersTemporaryFileAlone) {
  for (const OutputFile::Lasting lasting : {OutputFile::Lasting::yes, OutputFile::Lasting::recoverable}) {
    for (const auto& [is_there, is_expected] : {std::pair(false, false), {false, true}, {true, false}, {true, true}}) {
      const Scratch scratch;
      if (is_there) scratch.write("a", "what was there before");
      if (is_expected) expect_as_it_is(scratch / "a");
      OutputFile first(scratch / "a", lasting);
      first.write("first, still being written");
      {
        OutputFile second(scratch / "a", lasting);
        EXPECT_NE(second.temporary_path(), first.temporary_path());
        second.write("second");
        second.commit();
      }
      EXPECT_EQ(read_file(scratch / "a"), "second");
      std::string said;
      try {
        first.commit();
      } catch (const OutputError& error) {
        said = error.what();
      }
      EXPECT_EQ(read_file(scratch / "a"), is_expected ? "second" : "first, still being written");
      EXPECT_EQ(std::distance(fs::directory_iterator(scratch.folder()), fs::directory_iterator()), is_expected ? 2 : 1);
      if (!is_expected) continue;
      const std::string path = first.temporary_path().string();
      expect_says(said, "is not replaced; what was made is " + path);
      EXPECT_EQ(read_file(path), "first, still being written");
    }
  }
}

// As long as nobody touches it.
TEST(OutputFile, ReplacesWhatWasExpected) {
  for (const OutputFile::Lasting lasting : {OutputFile::Lasting::yes, OutputFile::Lasting::recoverable}) {
    const Scratch scratch;
    for (const char* text : {"new", "newer"}) {
      expect_as_it_is(scratch / "a");
      OutputFile file(scratch / "a", lasting);
      file.write(text);
      file.commit();
      EXPECT_EQ(read_file(scratch / "a"), text);
      EXPECT_EQ(std::distance(fs::directory_iterator(scratch.folder()), fs::directory_iterator()), 1);
    }
  }
}

void write_and_be_killed(const fs::path& path, OutputFile::Lasting lasting) {
  const pid_t child = fork();
  if (child == 0) {
    OutputFile file(path, lasting);
    file.write("a long text");
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
}

TEST(OutputFile, LeavesNothingOfAKilledProcess) {
  const Scratch scratch;
  const int without_name = open_nameless(scratch.folder(), O_WRONLY, 0600);
  if (without_name < 0) GTEST_SKIP() << "this system, or file system, has no files without names";
  close(without_name);
  scratch.write("a", "old");
  write_and_be_killed(scratch / "a", OutputFile::Lasting::yes);
  EXPECT_EQ(read_file(scratch / "a"), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch.folder()), fs::directory_iterator()), 1);
}

TEST(OutputFile, LeavesAKilledProcesssFileToBeRecovered) {
  const Scratch scratch;
  write_and_be_killed(scratch / "a", OutputFile::Lasting::recoverable);
  const auto left = files_with(scratch.folder(), ".a.nutik-");
  ASSERT_EQ(left.size(), 1u);
  {
    OutputFile file(scratch / "a");
    file.write("new");
    file.commit();
  }
  EXPECT_EQ(read_file(scratch / "a"), "new");
  EXPECT_EQ(read_file(left.front()), "a long text");
}

// While it is written nobody may read more of it than of what it replaces. A program that runs as its owner would be
// another one afterwards.
TEST(OutputFile, HasTheModeOfWhatItReplacesWithoutSetIdBits) {
  const auto mode_of = [](const fs::path& path) {
    return static_cast<unsigned>(fs::status(path).permissions());
  };
  const Scratch scratch;
  const mode_t before = umask(022);
  {
    OutputFile file(scratch / "new");
    EXPECT_EQ(mode_of(file.temporary_path()), 0644u);
    file.commit();
    EXPECT_EQ(mode_of(scratch / "new"), 0644u);
  }
  struct Tested {
    unsigned mode, kept;
  };
  for (const Tested& tested : {Tested{0600, 0600}, {0640, 0640}, {0444, 0444}, {0666, 0666}, {06755, 0755}}) {
    scratch.write("a", "old");
    fs::permissions(scratch / "a", fs::perms(tested.mode));
    OutputFile file(scratch / "a");
    EXPECT_EQ(mode_of(file.temporary_path()), 0600u);
    file.commit();
    EXPECT_EQ(mode_of(scratch / "a"), tested.kept);
  }
  umask(before);
}

// As Linux does it. Only an administrator can put a file there as another.
TEST(OutputFile, FollowsNoLinkOfAnotherInASharedFolder) {
  if (geteuid() != 0) GTEST_SKIP() << "only an administrator can give a link away";
  const Scratch scratch;
  fs::create_directory(scratch / "shared");
  scratch.write("victim", "precious");
  ASSERT_EQ(chmod((scratch / "shared").c_str(), 01777), 0);
  for (const char* target : {"../victim", "../absent"}) {
    const fs::path link = scratch / "shared" / fs::path(target).filename();
    fs::create_symlink(target, link);
    ASSERT_EQ(lchown(link.c_str(), 12345, 12345), 0);
    EXPECT_THROW(OutputFile{link}, OutputError);
    ASSERT_EQ(lchown(link.c_str(), geteuid(), getegid()), 0);
    OutputFile(link).write("what is not kept");
    ASSERT_EQ(chmod((scratch / "shared").c_str(), 0777), 0);
    ASSERT_EQ(lchown(link.c_str(), 12345, 12345), 0);
    OutputFile(link).write("what is not kept");
    ASSERT_EQ(chmod((scratch / "shared").c_str(), 01777), 0);
  }
  EXPECT_EQ(read_file(scratch / "victim"), "precious");
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch.folder()), fs::directory_iterator()), 2);
}

TEST(OutputFile, WithoutANameIsWrittenWhereItLies) {
  const NamelessFile nameless;
  {
    OutputFile file(nameless.path(), OutputFile::Lasting::no);
    file.write("some text");
    file.replace(5, std::as_bytes(std::span(std::string_view("more"))));
    file.commit();
  }
  EXPECT_EQ(read_file(nameless.path()), "some more");
  struct stat status {};
  ASSERT_EQ(fstat(nameless.descriptor(), &status), 0);
  EXPECT_EQ(status.st_nlink, 0u);
  EXPECT_EQ(status.st_mode & 07777u, 0600u);
}

// A file system that takes a name takes no longer one for the time until it is whole.
TEST(OutputFile, MayHaveTheLongestName) {
  const Scratch scratch;
  const auto temporary_of = [&](const std::string& name) {
    write_text(scratch / name, "old");
    OutputFile file(scratch / name, OutputFile::Lasting::recoverable);
    file.write("new");
    std::string temporary = file.temporary_path().filename();
    file.commit();
    EXPECT_EQ(read_file(scratch / name), "new");
    return temporary;
  };
  constexpr std::size_t kLongest = 255,
                        kUnshortened = kLongest - std::string_view("..nutik-0123456789abcdef.part").size();
  for (const std::size_t length : {kUnshortened - 1, kUnshortened, kUnshortened + 1, kLongest}) {
    const std::string name = std::string(length - 4, 'n') + ".tik";
    const std::string temporary = temporary_of(name);
    EXPECT_EQ(temporary.starts_with("." + name + ".nutik-"), length <= kUnshortened) << temporary;
    EXPECT_LE(temporary.size(), kLongest);
    EXPECT_TRUE(temporary.ends_with(".part")) << temporary;
  }
}

// Letters of several bytes are left out whole.
TEST(OutputFile, CutsNoLetterOfALongName) {
  const Scratch scratch;
  for (const char* const start : {"", "n", "nn"}) {
    std::string name = start;
    while (name.size() + 3 <= 255) name += "\u20ac";
    const OutputFile file(scratch / name, OutputFile::Lasting::recoverable);
    const std::string temporary = file.temporary_path().filename();
    std::string_view left = temporary;
    const std::string expected_start = std::string(".") + start;
    ASSERT_TRUE(left.starts_with(expected_start));
    left.remove_prefix(expected_start.size());
    while (left.starts_with("\u20ac")) left.remove_prefix(3);
    EXPECT_TRUE(left.starts_with(".nutik-")) << temporary;
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
    EXPECT_EQ(read_file(scratch / "there/b"), "new");
  }
  fs::create_symlink("two", scratch / "one");
  fs::create_symlink("one", scratch / "two");
  EXPECT_THROW(OutputFile(scratch / "one"), OutputError);
}

}  // namespace
}  // namespace nutik::test
