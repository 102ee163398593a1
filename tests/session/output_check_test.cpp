// What an output may replace.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "capture/error.hpp"
#include "session/output_check.hpp"
#include "support/scratch.hpp"
#include "system/is_absent.hpp"

namespace nutik::test {
namespace {

class OutputCheck : public testing::Test {
 protected:
  // Whether an output of this name may be written over a file with these bytes.
  [[nodiscard]] bool replaces(const std::string& name, const std::string& bytes,
                              OutputKind kind = OutputKind::picture) const {
    scratch_.write(name, bytes);
    try {
      check_output(scratch_ / name, kind, {});
      return true;
    } catch (const UsageError&) {
      return false;
    }
  }

  Scratch scratch_;
};

TEST_F(OutputCheck, PicturesOfEveryKindAreReplaced) {
  using namespace std::string_literals;
  for (const std::string& bytes : {"MM\0*...."s, "II+\0...."s, "MM\0+...."s, "P2 1 1"s, "P3 1 1"s, "P7\n"s, ""s}) {
    EXPECT_TRUE(replaces("picture.tif", bytes)) << testing::PrintToString(bytes);
  }
}

TEST_F(OutputCheck, NothingElseIs) {
  using namespace std::string_literals;
  for (const std::string& bytes :
       {"a letter"s, "Dear"s, "P"s, "P7"s, "P4\n"s, "II"s, "MM"s, "MM+\0"s, "\x89PN"s, "\xFF\xD8"s, "M0 [0:1]\n"s}) {
    EXPECT_FALSE(replaces("picture.tif", bytes)) << testing::PrintToString(bytes);
  }
}

TEST_F(OutputCheck, TablesAndPathsOfCamerasAreReplaced) {
  EXPECT_TRUE(replaces("table.csv", "time,gain\n", OutputKind::table));
  EXPECT_TRUE(replaces("path.csv", "# nutik camera path,rigid,0,400,300\n", OutputKind::table));
  EXPECT_FALSE(replaces("letter.csv", "Dear reader\n", OutputKind::table));
}

// Only the system's word that nothing is there makes a name free. An administrator may look at everything, and tries it
// as somebody else.
TEST_F(OutputCheck, NothingIsReplacedThatCannotBeLookedAt) {
  namespace fs = std::filesystem;
  fs::permissions(scratch_.folder(), fs::perms(0755));
  scratch_.write("letter.png", "Dear reader");
  fs::permissions(scratch_ / "letter.png", fs::perms::none);
  fs::create_directory(scratch_ / "closed");
  scratch_.write("closed/letter.png", "Dear reader");
  fs::create_symlink("closed/letter.png", scratch_ / "link.png");
  fs::permissions(scratch_ / "closed", fs::perms::none);
  const pid_t child = fork();
  if (child == 0) {
    constexpr uid_t kSomebody = 12'345;
    if (geteuid() == 0 && seteuid(kSomebody) != 0) _exit(100);
    int replaced = 0;
    for (const char* name : {"letter.png", "closed/letter.png", "closed/new.png", "link.png"}) {
      replaced += static_cast<int>(is_absent(scratch_ / name));
      try {
        check_output(scratch_ / name, OutputKind::picture, {});
        ++replaced;
      } catch (const OutputError&) {
      }
    }
    _exit(replaced);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0) << "names of four that may be replaced";
  fs::permissions(scratch_ / "closed", fs::perms::owner_all);
  EXPECT_TRUE(is_absent(scratch_ / "new.png"));
  EXPECT_TRUE(is_absent(scratch_ / "letter.png" / "new.png"));
  EXPECT_FALSE(is_absent(scratch_ / "link.png"));
}

}  // namespace
}  // namespace nutik::test
