// Long exposures take sums of blocks over from the pictures before: their files have the same bytes all the same, made
// first or last, alone, in parts or again.
#include <gtest/gtest.h>

#include "capture/format.hpp"
#include "support/app_test.hpp"
#include "support/still_clip.hpp"

namespace nutik::test {
namespace {

// 25 blocks, of which a long exposure holds a group of 16 and more.
class KeptSumsInFiles : public AppTest {
 protected:
  void SetUp() override {
    write_still_clip(scratch_.folder(), 24, 400);
    make("-q -f 1000 --block-samples 16 frames clip.tik");
  }
  void takes_sums_over(const Words& words) const { expect_says(make(words).out, " sums of others kept"); }
};

TEST_F(KeptSumsInFiles, OfAFilmAreThoseOfItsParts) {
  const auto film = [](const std::string& folder) {
    return Words("video -v --out-fps 100 --out-angle 10000 --depth 16 clip.tik " + folder + "/f-%02d.png");
  };
  for (const char* folder : {"whole", "parts"}) std::filesystem::create_directory(scratch_ / folder);
  takes_sums_over(film("whole"));
  for (const char* frames : {"7-12", "0", "1-6"}) {
    make(film("parts") + "--frames" + frames);
  }
  for (int k = 0; k <= 12; ++k) {
    const std::string name = format("/f-{:02}.png", k);
    EXPECT_FALSE(file("whole" + name).empty()) << k;
    EXPECT_TRUE(file("whole" + name) == file("parts" + name)) << k;
  }
  for (const char* picture : {"whole/f-00.png", "whole/f-12.png"}) expect_made_again(picture);
}

TEST_F(KeptSumsInFiles, OfSeriesSweepsAndBatchesAreThoseOfOnePicture) {
  takes_sums_over("-v --exposure 0.31s --every 7ms --count 9 clip.tik s-%d.tif");
  scratch_.write("list.txt",
                 "--start 49ms --exposure 0.31s b-0.tif\n--start 56ms --exposure 0.31s b-1.tif\n");
  takes_sums_over("batch -v list.txt clip.tik");
  make("--start 49ms --exposure 0.31s clip.tik alone-7.tif");
  make("--start 56ms --exposure 0.31s clip.tik alone-8.tif");
  for (const auto& [alone, others] : {std::pair("alone-7.tif", std::vector{"s-7.tif", "b-0.tif"}),
                                      std::pair("alone-8.tif", std::vector{"s-8.tif", "b-1.tif"})}) {
    for (const char* other : others) EXPECT_TRUE(file(alone) == file(other)) << other;
  }
  for (const char* picture : {"s-8.tif", "b-1.tif"}) expect_made_again(picture);

  // A sweep states times in other words: without them, too.
  const auto sweep = [&](const std::string& name, const Words& more) {
    make("sweep --exposure 0.31s --shift 0ms..56ms/7ms clip.tik " + name + ".png --each " + name + "-%d.tif" + more);
  };
  sweep("w", {});
  expect_made_again("w-8.tif");
  sweep("n", {"--no-recipe"});
  make("--start 56ms --exposure 0.31s --no-recipe clip.tik plain.tif");
  EXPECT_TRUE(file("n-8.tif") == file("plain.tif"));
}

}  // namespace
}  // namespace nutik::test
