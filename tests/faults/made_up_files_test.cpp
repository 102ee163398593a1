// Files that nobody's program wrote: every check sum is right, and what they say cannot be.
#include <gtest/gtest.h>

#include "support/made_up_tik.hpp"
#include "support/program_test.hpp"

namespace nutik::test {
namespace {

struct MadeUpFiles : ProgramTest {};

// A kernel takes such numbers for the block's end, the reference for damage. Neither is asked.
TEST_F(MadeUpFiles, AreRefusedAlikeByEveryRendererAndByCheck) {
  struct Case {
    std::string complaint;
    MadeUpTile tile;
  };
  const std::vector<Case> cases{
      {"", MadeUpTile::rows({0, 3, 9})},
      {"", MadeUpTile::slots({3, 9, 16}, 5, {1, 16, 16})},
      {"tile 0: its first row is at sample 1, not 0", MadeUpTile::rows({1, 3, 9})},
      {"tile 0: its row 2 is at sample 3 of 16, the one before at 3", MadeUpTile::rows({0, 3, 3})},
      {"tile 0: its row 2 is at sample 2 of 16, the one before at 3", MadeUpTile::rows({0, 3, 2})},
      {"tile 0: its row 2 is at sample 16 of 16", MadeUpTile::rows({0, 3, 16})},
      {"tile 0: its row 1 is at sample 200 of 16", MadeUpTile::rows({0, 200, 201})},
      {"tile 0, pixel 63: its change record 0 is at sample 0 of 16", MadeUpTile::slots({3, 9}, 63, {0, 9})},
      {"tile 0, pixel 5: its change record 1 is at sample 3 of 16, the one before at 3",
       MadeUpTile::slots({3, 9}, 5, {3, 3})},
      {"tile 0, pixel 5: its change record 1 is at sample 2 of 16", MadeUpTile::slots({3, 9}, 5, {3, 2})},
      {"tile 0, pixel 5: its change record 1 is at sample 17 of 16", MadeUpTile::slots({3, 9}, 5, {3, 17})},
      {"tile 0, pixel 0: its change record 1 is at sample 9 of 16, the one before at 16",
       MadeUpTile::slots({3, 9}, 0, {16, 9})},
  };
  for (const Case& made_up : cases) {
    for (const char* codec : {"none", "rice", "lz4", "zstd"}) {
      SCOPED_TRACE(made_up.complaint + ", " + codec);
      write_made_up_tik(scratch_ / "c.tik", made_up.tile, tik::Codec::parse(codec));
      for (const char* renderer : {"reference", "opencl"}) {
        SCOPED_TRACE(renderer);
        const auto result =
            run({"expose", "--start", "0s", "--exposure", "1s", "--renderer", renderer, "c.tik", "p.png"});
        EXPECT_EQ(result.status, made_up.complaint.empty() ? 0 : 3) << result.err;
        expect_says(result.err, made_up.complaint);
        EXPECT_EQ(std::filesystem::remove(scratch_ / "p.png"), made_up.complaint.empty());
      }
      const auto check = run({"check", "c.tik"});
      EXPECT_EQ(check.status, made_up.complaint.empty() ? 0 : 3) << check.out << check.err;
      expect_says(check.out, made_up.complaint);
    }
  }
}

// Nobody stated this rate: the file is wrong, and named.
TEST_F(MadeUpFiles, WithARateThatCannotBeAreNamed) {
  for (const char* rate : {"0", "-3", "1234567890123", "1/999999999999", "1/900000000"}) {
    SCOPED_TRACE(rate);
    write_made_up_tik(scratch_ / "c.tik", MadeUpTile::rows({0, 3, 9}), {tik::CodecId::none, 0}, rate);
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"info", "c.tik"},
             {"expose", "--start", "0s", "--exposure", "1f", "c.tik", "p.png"},
             {"activity", "c.tik", "a.png"}}) {
      expect_refused(words, 3, "c.tik: its times are damaged: ");
    }
  }
}

}  // namespace
}  // namespace nutik::test
