// Nothing that a command reads is replaced by what it writes, and nobody else's file either.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "support/program.hpp"
#include "support/scratch.hpp"

namespace nutik {
namespace {

using test::Scratch;

class Outputs : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(scratch_ / "frames");
    for (int k = 0; k < 4; ++k) {
      const cv::Mat picture(120, 160, CV_8UC1, cv::Scalar::all(40 * k));
      cv::imwrite((scratch_ / ("frames/" + std::to_string(k) + ".png")).string(), picture);
    }
  }
  Scratch scratch_;
};

TEST_F(Outputs, ReplaceNoStillOfTheClip) {
  const std::string still = test::read_file(scratch_ / "frames/1.png");
  const std::vector<std::vector<std::string>> commands{
      {"expose", "--exposure", "1f"},
      {"contact"},
      {"mask", "--moving"},
      {"sweep", "--start", "0s", "--exposure", "1f", "--shift", "0f..2f/1f"},
      {"trace", "--pixel", "1,1", "--start", "0s", "--exposure", "1f"},
      {"activity"},
      {"activity", "--map", "frames/1.png"}};
  for (std::vector<std::string> words : commands) {
    words.insert(words.end(), {"-f", "100", "frames", "-o"});
    words.emplace_back(words[1] == "--map" ? "chart.png" : "frames/1.png");
    const auto result = test::run_program(words, scratch_.folder());
    EXPECT_EQ(result.status, 2) << words.front();
    EXPECT_NE(result.err.find("the output frames/1.png is also an input"), std::string::npos)
        << words.front() << ": " << result.err;
    EXPECT_TRUE(test::read_file(scratch_ / "frames/1.png") == still) << words.front();
  }
}

// The temporary capture's name cannot be foreseen, and what somebody put in its place is not written to.
TEST_F(Outputs, AreNotLedAstrayInATemporaryFolder) {
  std::filesystem::create_directory(scratch_ / "tmp");
  scratch_.write("victim", "precious");
  const auto result =
      test::run_shell(std::string("ln -s ../victim tmp/nutik-$$.tik; TMPDIR=tmp exec ") + NUTIK_TEST_PROGRAM +
                          " contact --renderer reference -f 100 frames sheet.png",
                      scratch_.folder());
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(test::read_file(scratch_ / "victim"), "precious");
  const std::filesystem::directory_iterator files(scratch_ / "tmp");
  EXPECT_EQ(std::distance(files, std::filesystem::directory_iterator()), 1);  // the link
}

}  // namespace
}  // namespace nutik
