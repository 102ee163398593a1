// Long exposures take sums of blocks over from the pictures before: their files have the same bytes all the same, made
// first or last, alone, in parts or again.
#include <gtest/gtest.h>

#include "capture/format.hpp"
#include "support/program_test.hpp"
#include "support/still_clip.hpp"

namespace nutik {
namespace {

// 25 blocks, of which a long exposure holds a group of 16 and more.
class KeptSumsInFiles : public test::ProgramTest {
 protected:
  void SetUp() override {
    test::write_still_clip(scratch_.folder(), 24, 400);
    done({"-q", "-f", "1000", "--block-samples", "16", "frames", "clip.tik"});
  }
  test::ProgramResult done(const std::vector<std::string>& words) const {
    test::ProgramResult result = run(words);
    EXPECT_EQ(result.status, 0) << result.err;
    return result;
  }
  void takes_sums_over(const std::vector<std::string>& words) const {
    const std::string said = done(words).out;
    EXPECT_NE(said.find(" sums of others kept"), std::string::npos) << said;
  }
  [[nodiscard]] std::string file(const std::string& name) const { return test::read_file(scratch_ / name); }
  void expect_same_again(const std::string& picture) const {
    const std::string before = file(picture);
    ASSERT_FALSE(before.empty()) << picture;
    scratch_.write("again.sh", done({"again", picture}).out);
    std::filesystem::remove(scratch_ / picture);
    EXPECT_EQ(test::run_shell("sh again.sh", scratch_.folder()).status, 0);
    EXPECT_TRUE(file(picture) == before) << picture;
  }
};

TEST_F(KeptSumsInFiles, OfAFilmAreThoseOfItsParts) {
  const auto film = [](const std::string& folder) {
    return std::vector<std::string>{"video", "-v",      "--out-fps", "100",      "--out-angle",
                                    "10000", "--depth", "16",        "clip.tik", folder + "/f-%02d.png"};
  };
  for (const char* folder : {"whole", "parts"}) std::filesystem::create_directory(scratch_ / folder);
  takes_sums_over(film("whole"));
  for (const char* frames : {"7-12", "0", "1-6"}) {
    std::vector<std::string> part = film("parts");
    part.insert(part.end(), {"--frames", frames});
    done(part);
  }
  for (int k = 0; k <= 12; ++k) {
    const std::string name = format("/f-{:02}.png", k);
    EXPECT_FALSE(file("whole" + name).empty()) << k;
    EXPECT_TRUE(file("whole" + name) == file("parts" + name)) << k;
  }
  for (const char* picture : {"whole/f-00.png", "whole/f-12.png"}) expect_same_again(picture);
}

TEST_F(KeptSumsInFiles, OfSeriesSweepsAndBatchesAreThoseOfOnePicture) {
  takes_sums_over({"-v", "--exposure", "0.31s", "--every", "7ms", "--count", "9", "clip.tik", "s-%d.tif"});
  scratch_.write("list.txt",
                 "--start 49ms --exposure 0.31s b-0.tif\n--start 56ms --exposure 0.31s b-1.tif\n");
  takes_sums_over({"batch", "-v", "list.txt", "clip.tik"});
  done({"--start", "49ms", "--exposure", "0.31s", "clip.tik", "alone-7.tif"});
  done({"--start", "56ms", "--exposure", "0.31s", "clip.tik", "alone-8.tif"});
  for (const auto& [alone, others] : {std::pair("alone-7.tif", std::vector{"s-7.tif", "b-0.tif"}),
                                      std::pair("alone-8.tif", std::vector{"s-8.tif", "b-1.tif"})}) {
    for (const char* other : others) EXPECT_TRUE(file(alone) == file(other)) << other;
  }
  for (const char* picture : {"s-8.tif", "b-1.tif"}) expect_same_again(picture);

  // A sweep states times in other words: without them, too.
  const auto sweep = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> words{"sweep",    "--exposure",  "0.31s",  "--shift",       "0ms..56ms/7ms",
                                   "clip.tik", name + ".png", "--each", name + "-%d.tif"};
    words.insert(words.end(), more.begin(), more.end());
    done(words);
  };
  sweep("w", {});
  expect_same_again("w-8.tif");
  sweep("n", {"--no-recipe"});
  done({"--start", "56ms", "--exposure", "0.31s", "--no-recipe", "clip.tik", "plain.tif"});
  EXPECT_TRUE(file("n-8.tif") == file("plain.tif"));
}

}  // namespace
}  // namespace nutik
