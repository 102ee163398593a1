// No output of a command replaces another one of the same command.
#include <gtest/gtest.h>

#include "support/made_up_tik.hpp"
#include "support/program_test.hpp"

namespace nutik::test {
namespace {

struct OwnOutputs : ProgramTest {};

TEST_F(OwnOutputs, OfASweepAreNotTheSheet) {
  write_made_up_tik(scratch_ / "c.tik", MadeUpTile::rows({0, 3, 9}), {tik::CodecId::none, 0});
  for (const char* sheet : {"q-01.png", "./q-01.png"}) {
    expect_refused({"sweep", "--renderer", "reference", "--start", "0s", "--exposure", "1f", "--shift",
                    "0f..2f/1f", "--each", "q-%02d.png", "c.tik", sheet},
                   2, "--each names a picture q-01.png and the sheet is ");
    EXPECT_FALSE(std::filesystem::exists(scratch_ / "q-01.png"));
  }
}

TEST_F(OwnOutputs, AreNotMadeInAFolderThatIsGone) {
  write_made_up_tik(scratch_ / "c.tik", MadeUpTile::rows({0, 3, 9}), {tik::CodecId::none, 0});
  const auto result = run_shell("c=$PWD/c.tik; mkdir gone; cd gone; rmdir ../gone; \"" NUTIK_TEST_PROGRAM
                                "\" --renderer reference --start 0s --exposure 1f \"$c\"", scratch_.folder());
  EXPECT_EQ(result.status, 5);
  expect_says(result.err, "the current folder is no longer there; go to another one");
}

}  // namespace
}  // namespace nutik::test
