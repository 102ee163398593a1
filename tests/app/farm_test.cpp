// What render farms ask of a program: parts of a job by number, nothing made twice, a line of progress, and an exit
// status that says if it is worth trying again.
#include <gtest/gtest.h>

#include "support/app_test.hpp"

namespace nutik::test {
namespace {

class Farm : public AppTest {
 protected:
  void SetUp() override {
    make_scene();
    scratch_.write("trail.fn", "M0 [0:0], [10000000:1], [20000000:0]\n");
  }
  [[nodiscard]] auto written_at(const std::string& name) const {
    return std::filesystem::last_write_time(scratch_ / name);
  }
  // Takes a picture's time far back, so that it shows whether it was made again.
  void age(const std::string& name) const {
    std::filesystem::last_write_time(scratch_ / name, written_at(name) - std::chrono::hours(1));
  }
};

TEST_F(Farm, MakesTheFramesOfAVideoThatAreNotThere) {
  const Words film("video --out-fps 100 scene.tik f-%d.png --skip-existing");
  const auto with = [&](const Words& more) { return make(film + more).out; };
  expect_says(with({"--frames", "1-100x2"}), "f-%d.png: 9 x 7 grey, 3 frames (");
  EXPECT_FALSE(exists("f-0.png"));
  EXPECT_TRUE(exists("f-5.png"));
  age("f-1.png");
  const auto before = written_at("f-1.png");
  scratch_.write("f-3.png", file("f-3.png").substr(0, 60));  // cut off before its recipe
  static_cast<void>(make("video --out-fps 100 scene.tik f-%d.png --skip-existing", 2));
  expect_says(with({"--overwrite"}), " 4 frames (");
  EXPECT_EQ(written_at("f-1.png"), before);
  EXPECT_EQ(with({}), "f-%d.png: 6 frames, there already\n");
  // Another angle is another recipe.
  expect_says(with({"--out-angle", "90"}), " 6 frames (");
  EXPECT_NE(written_at("f-1.png"), before);
  // An arithmetic that was stated is another than the one that auto chose, or the same.
  static_cast<void>(with({"--precision", "double"}));
  EXPECT_EQ(with({"--precision", "double"}), "f-%d.png: 6 frames, there already\n");
  expect_says(with({"--precision", "fixed"}), " 6 frames (");
}

TEST_F(Farm, MakesThePicturesOfASeriesThatAreNotThere) {
  const Words series("--exposure 10ms --every 1f scene.tik s-%02d.png");
  static_cast<void>(make(series));
  std::vector<std::string> whole;
  for (int k = 0; k < 6; ++k) whole.push_back(file("s-0" + std::to_string(k) + ".png"));
  for (const char* name : {"s-01.png", "s-04.png", "s-05.png"}) std::filesystem::remove(scratch_ / name);
  expect_says(make(series + "--frames 0-1,5-9 --skip-existing").out,
              {"s-01.png … s-05.png: 2 exposures every 1f", ", 1 exposure there already"});
  EXPECT_FALSE(exists("s-04.png"));
  EXPECT_EQ(file("s-01.png"), whole[1]);
  EXPECT_EQ(file("s-05.png"), whole[5]);
  expect_says(make(series + "--frames 6-9", 2).err,
              "none of the exposures 6-9 is there: the series has 6, numbered from 0 to 5");
}

TEST_F(Farm, MakesTheLinesOfABatchThatAreNotThere) {
  scratch_.write("list.txt",
                 "# pictures\n--start 0f --exposure 1f a.png\n-k trail.fn b.png\n--start 2f --exposure 1f c.png\n");
  EXPECT_TRUE(make("batch --frames 2-3 list.txt scene.tik").out.starts_with("2 of 2 pictures, "));
  EXPECT_FALSE(exists("c.png"));
  for (const char* name : {"a.png", "b.png"}) age(name);
  const auto before = written_at("a.png");
  scratch_.write("trail.fn", "M0 [0:0], [10000000:1], [30000000:0]\n");
  const ProgramResult rest = make("batch --skip-existing --json list.txt scene.tik");
  expect_says(rest.out, "\"skipped\": 1");
  EXPECT_EQ(written_at("a.png"), before);
  EXPECT_NE(written_at("b.png"), before) << "with other functions";
  EXPECT_TRUE(exists("c.png"));
  EXPECT_TRUE(
      make("batch --skip-existing list.txt scene.tik").out.starts_with("3 of 3 pictures, 3 there already"));
  expect_says(make("batch --frames 9 list.txt scene.tik", 2).err, "lists no exposure in lines 9");
  scratch_.write("inner.txt", "--frames 2 --start 0f --exposure 1f a.png\n");
  expect_says(make("batch inner.txt scene.tik", 1).err, "--frames chooses lines of the list");
}

TEST_F(Farm, KnowsASinglePictureToo) {
  const Words words("-k trail.fn --skip-existing scene.tik p.tif");
  EXPECT_TRUE(make(words).out.starts_with("p.tif: 9 x 7"));
  EXPECT_EQ(make(words).out, "p.tif: 1 picture, there already\n");
  make("-f 50 --overwrite still%d.pgm scene.tik");
  EXPECT_TRUE(make(words).out.starts_with("p.tif: 9 x 7")) << "of another capture of that name";
}

TEST_F(Farm, RefusesToSkipWhatCarriesNoRecipe) {
  expect_says(make("video --skip-existing scene.tik v.mkv", 2).err, "v.mkv has no place for one");
  for (const char* kind : {"pfm", "PFM", "npy"})
    expect_says(make(std::string("video --skip-existing scene.tik v-%d.") + kind, 2).err, "has no place for one");
  expect_says(make("-k trail.fn --skip-existing --no-recipe scene.tik a.png", 2).err,
              "--no-recipe makes them without; use one");
  expect_says(make("-k trail.fn --frames 1 scene.tik a.png", 2).err, "add --every");
  // What is there under the name is no picture: not replaced, not skipped.
  scratch_.write("a.png", "a letter");
  expect_says(make("-k trail.fn --skip-existing scene.tik a.png", 2).err, "a.png");
  EXPECT_EQ(file("a.png"), "a letter");
  // One that was changed or cut off since it was made is neither, too, whatever its recipe says.
  make("-k trail.fn scene.tik b.pgm");
  const std::string changed = file("b.pgm").substr(0, file("b.pgm").size() - 1);
  scratch_.write("b.pgm", changed);
  for (const char* words : {"-k trail.fn --skip-existing scene.tik b.pgm", "-k trail.fn scene.tik b.pgm"})
    expect_says(make(words, 2).err, "b.pgm is there already and is not replaced: its recipe does not know it as it is");
  EXPECT_EQ(file("b.pgm"), changed);
}

TEST_F(Farm, PrintsLinesOfProgressWhereThereIsNoTerminal) {
  const ProgramResult video = make("video --progress -q --out-fps 100 scene.tik f-%d.png");
  EXPECT_TRUE(video.err.starts_with("Progress: 0% exposing 0 of 6\n")) << video.err;
  const ProgramResult clip = make("video --progress -q -f 100 --out-fps 100 still%d.pgm f-%d.png");
  expect_says(clip.err, "\nProgress: 0% exposing 0 of 6\n");
  EXPECT_TRUE(clip.err.starts_with("reading 1 of 6")) << clip.err;
  EXPECT_TRUE(make("--progress --exposure 10ms --every 2f scene.tik s-%d.png")
                  .err.starts_with("Progress: 0% exposing 0 of 3\n"));
  scratch_.write("list.txt", "--start 0f --exposure 1f a.png\n");
  EXPECT_TRUE(make("batch --progress list.txt scene.tik").err.starts_with("Progress: 0% exposing 0 of 1\n"));
  expect_says(make("encode --progress -f 100 still%d.pgm e.tik").err, "% encoding ");
  EXPECT_EQ(make("video --out-fps 100 scene.tik f-%d.png").err, "");
}

TEST_F(Farm, TellsByItsStatusWhetherToTryAgain) {
  scratch_.write("list.txt", "--start 9s --exposure 1f late.png\n");
  static_cast<void>(make("batch list.txt scene.tik", 1));
  scratch_.write("list.txt", "--start 9s --exposure 1f late.png\n--start 0f --exposure 1f absent/e.png\n");
  static_cast<void>(make("batch list.txt scene.tik", 5));
  static_cast<void>(make("video --frames 0 scene.tik absent/v-%d.png", 5));
  static_cast<void>(make({"video", "--device", "no such device", "scene.tik", "v-%d.png"}, 4));
}

}  // namespace
}  // namespace nutik::test
