// Kernels that were kept are native code: others' are not loaded, and the program says so.
#include <gtest/gtest.h>

#include "support/made_up_tik.hpp"
#include "support/program_test.hpp"

namespace nutik {
namespace {

namespace fs = std::filesystem;

struct KernelCache : test::ProgramTest {
  void SetUp() override {
    test::write_made_up_tik(scratch_ / "c.tik", test::MadeUpTile::rows({0, 3, 9}), {tik::CodecId::none, 0});
    fs::create_directories(cache_);
  }
  [[nodiscard]] test::ProgramResult expose() const {
    return test::run_program({"--start", "0s", "--exposure", "1s", "c.tik", "p.png"}, scratch_.folder(),
                             {"XDG_CACHE_HOME=" + (scratch_ / "home").string()});
  }
  fs::path cache_ = scratch_ / "home/nutik-cl";
};

TEST_F(KernelCache, ThatOthersMayWriteToIsNotUsed) {
  fs::permissions(cache_, fs::perms::all);
  const auto result = expose();
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.err.find("built kernels are not kept: other users may write to " + cache_.string()),
            std::string::npos)
      << result.err;
  EXPECT_TRUE(fs::is_empty(cache_));
  EXPECT_EQ(
      test::run_program({"devices"}, scratch_.folder(), {"XDG_CACHE_HOME=" + (scratch_ / "home").string()})
          .status,
      0);
}

TEST_F(KernelCache, WithFoldersForFilesFailsNoExposure) {
  fs::permissions(cache_, fs::perms::owner_all);
  ASSERT_EQ(expose().status, 0);
  std::vector<fs::path> kept;
  for (const auto& file : fs::directory_iterator(cache_)) kept.push_back(file.path());
  ASSERT_GE(kept.size(), 3u);  // both kernels, and the verdict on them
  for (const fs::path& file : kept) {
    fs::remove(file);
    fs::create_directory(file);
  }
  const auto result = expose();
  EXPECT_EQ(result.status, 0) << result.err;
  const auto devices =
      test::run_program({"devices"}, scratch_.folder(), {"XDG_CACHE_HOME=" + (scratch_ / "home").string()});
  EXPECT_EQ(devices.status, 0) << devices.err;
}

}  // namespace
}  // namespace nutik
