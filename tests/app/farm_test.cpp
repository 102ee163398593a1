// What render farms ask of a program: parts of a job by number, nothing made twice, a line of progress, and an exit
// status that says if it is worth trying again.
#include <gtest/gtest.h>

#include "support/program_test.hpp"

namespace nutik {
namespace {

using test::ProgramResult;

class Farm : public test::ProgramTest {
 protected:
  void SetUp() override {
    for (int k = 0; k < 6; ++k) {
      std::string still = "P5\n9 7\n255\n";
      for (int i = 0; i < 9 * 7; ++i) still += static_cast<char>(40 + 20 * k + i);
      scratch_.write("still" + std::to_string(k) + ".pgm", still);
    }
    ASSERT_EQ(run({"-f", "100", "still%d.pgm", "scene.tik"}).status, 0);
    scratch_.write("trail.fn", "M0 [0:0], [10000000:1], [20000000:0]\n");
  }
  [[nodiscard]] ProgramResult done(const std::vector<std::string>& words, int status = 0) const {
    ProgramResult result = test::run_program(words, scratch_.folder());
    EXPECT_EQ(result.status, status) << result.out << result.err;
    return result;
  }
  [[nodiscard]] bool is_there(const std::string& name) const { return std::filesystem::exists(scratch_ / name); }
  [[nodiscard]] std::string file(const std::string& name) const { return test::read_file(scratch_ / name); }
  [[nodiscard]] auto written_at(const std::string& name) const {
    return std::filesystem::last_write_time(scratch_ / name);
  }
  // Takes a picture's time far back, so that it shows whether it was made again.
  void age(const std::string& name) const {
    std::filesystem::last_write_time(scratch_ / name, written_at(name) - std::chrono::hours(1));
  }
};

TEST_F(Farm, MakesTheFramesOfAVideoThatAreNotThere) {
  const std::vector<std::string> film{"video", "--out-fps", "100", "scene.tik", "f-%d.png", "--skip-existing"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), film.begin(), film.end());
    return done(more).out;
  };
  EXPECT_NE(with({"--frames", "1-100x2"}).find("f-%d.png: 9 x 7 grey, 3 frames ("), std::string::npos);
  EXPECT_FALSE(is_there("f-0.png"));
  EXPECT_TRUE(is_there("f-5.png"));
  age("f-1.png");
  const auto before = written_at("f-1.png");
  scratch_.write("f-3.png", file("f-3.png").substr(0, 60));  // cut off before its recipe
  static_cast<void>(done({"video", "--out-fps", "100", "scene.tik", "f-%d.png", "--skip-existing"}, 2));
  EXPECT_NE(with({"--overwrite"}).find(" 4 frames ("), std::string::npos) << "0, 2, 4, and 3 anew";
  EXPECT_EQ(written_at("f-1.png"), before);
  EXPECT_EQ(with({}), "f-%d.png: 6 frames, there already\n");
  // Another angle is another recipe.
  EXPECT_NE(with({"--out-angle", "90"}).find(" 6 frames ("), std::string::npos);
  EXPECT_NE(written_at("f-1.png"), before);
  // An arithmetic that was stated is another than the one that auto chose, or the same.
  static_cast<void>(with({"--precision", "double"}));
  EXPECT_EQ(with({"--precision", "double"}), "f-%d.png: 6 frames, there already\n");
  EXPECT_NE(with({"--precision", "fixed"}).find(" 6 frames ("), std::string::npos);
}

TEST_F(Farm, MakesThePicturesOfASeriesThatAreNotThere) {
  const std::vector<std::string> series{"--exposure", "10ms", "--every", "1f", "scene.tik", "s-%02d.png"};
  static_cast<void>(done(series));
  std::vector<std::string> whole;
  for (int k = 0; k < 6; ++k) whole.push_back(file("s-0" + std::to_string(k) + ".png"));
  for (const char* name : {"s-01.png", "s-04.png", "s-05.png"}) std::filesystem::remove(scratch_ / name);
  std::vector<std::string> words = series;
  words.insert(words.end(), {"--frames", "0-1,5-9", "--skip-existing"});
  const ProgramResult some = done(words);
  EXPECT_NE(some.out.find("s-01.png … s-05.png: 2 exposures every 1f"), std::string::npos) << some.out;
  EXPECT_NE(some.out.find(", 1 exposure there already"), std::string::npos) << some.out;
  EXPECT_FALSE(is_there("s-04.png"));
  EXPECT_EQ(file("s-01.png"), whole[1]);
  EXPECT_EQ(file("s-05.png"), whole[5]);
  words = series;
  words.insert(words.end(), {"--frames", "6-9"});
  EXPECT_NE(done(words, 2).err.find("none of the exposures 6-9 is there: the series has 6, numbered from 0 to 5"),
            std::string::npos);
}

TEST_F(Farm, MakesTheLinesOfABatchThatAreNotThere) {
  scratch_.write("list.txt",
                 "# pictures\n--start 0f --exposure 1f a.png\n-k trail.fn b.png\n--start 2f --exposure 1f c.png\n");
  EXPECT_TRUE(done({"batch", "--frames", "2-3", "list.txt", "scene.tik"}).out.starts_with("2 of 2 pictures, "));
  EXPECT_FALSE(is_there("c.png"));
  for (const char* name : {"a.png", "b.png"}) age(name);
  const auto before = written_at("a.png");
  scratch_.write("trail.fn", "M0 [0:0], [10000000:1], [30000000:0]\n");
  const ProgramResult rest = done({"batch", "--skip-existing", "--json", "list.txt", "scene.tik"});
  EXPECT_NE(rest.out.find("\"skipped\": 1"), std::string::npos) << rest.out;
  EXPECT_EQ(written_at("a.png"), before);
  EXPECT_NE(written_at("b.png"), before) << "with other functions";
  EXPECT_TRUE(is_there("c.png"));
  EXPECT_TRUE(done({"batch", "--skip-existing", "list.txt", "scene.tik"})
                  .out.starts_with("3 of 3 pictures, 3 there already"));
  EXPECT_NE(done({"batch", "--frames", "9", "list.txt", "scene.tik"}, 2).err.find("lists no exposure in lines 9"),
            std::string::npos);
  scratch_.write("inner.txt", "--frames 2 --start 0f --exposure 1f a.png\n");
  EXPECT_NE(done({"batch", "inner.txt", "scene.tik"}, 1).err.find("--frames chooses lines of the list"),
            std::string::npos);
}

TEST_F(Farm, KnowsASinglePictureToo) {
  const std::vector<std::string> words{"-k", "trail.fn", "--skip-existing", "scene.tik", "p.tif"};
  EXPECT_TRUE(done(words).out.starts_with("p.tif: 9 x 7"));
  EXPECT_EQ(done(words).out, "p.tif: 1 picture, there already\n");
  ASSERT_EQ(run({"-f", "50", "--overwrite", "still%d.pgm", "scene.tik"}).status, 0);
  EXPECT_TRUE(done(words).out.starts_with("p.tif: 9 x 7")) << "of another capture of that name";
}

TEST_F(Farm, RefusesToSkipWhatCarriesNoRecipe) {
  EXPECT_NE(done({"video", "--skip-existing", "scene.tik", "v.mkv"}, 2).err.find("v.mkv has no place for one"),
            std::string::npos);
  EXPECT_NE(done({"video", "--skip-existing", "scene.tik", "v-%d.pfm"}, 2).err.find("has no place for one"),
            std::string::npos);
  EXPECT_NE(done({"-k", "trail.fn", "--skip-existing", "--no-recipe", "scene.tik", "a.png"}, 2)
                .err.find("--no-recipe makes them without; use one"),
            std::string::npos);
  EXPECT_NE(done({"-k", "trail.fn", "--frames", "1", "scene.tik", "a.png"}, 2).err.find("add --every"),
            std::string::npos);
  // What is there under the name is no picture: not replaced, not skipped.
  scratch_.write("a.png", "a letter");
  EXPECT_NE(done({"-k", "trail.fn", "--skip-existing", "scene.tik", "a.png"}, 2).err.find("a.png"),
            std::string::npos);
  EXPECT_EQ(file("a.png"), "a letter");
}

TEST_F(Farm, PrintsLinesOfProgressWhereThereIsNoTerminal) {
  const ProgramResult video =
      done({"video", "--progress", "-q", "--out-fps", "100", "scene.tik", "f-%d.png"});
  EXPECT_TRUE(video.err.starts_with("Progress: 0% exposing 0 of 6\n")) << video.err;
  const ProgramResult clip =
      done({"video", "--progress", "-q", "-f", "100", "--out-fps", "100", "still%d.pgm", "f-%d.png"});
  EXPECT_NE(clip.err.find("\nProgress: 0% exposing 0 of 6\n"), std::string::npos) << clip.err;
  EXPECT_TRUE(clip.err.starts_with("reading 1 of 6")) << clip.err;
  EXPECT_TRUE(done({"--progress", "--exposure", "10ms", "--every", "2f", "scene.tik", "s-%d.png"})
                  .err.starts_with("Progress: 0% exposing 0 of 3\n"));
  scratch_.write("list.txt", "--start 0f --exposure 1f a.png\n");
  EXPECT_TRUE(done({"batch", "--progress", "list.txt", "scene.tik"}).err.starts_with("Progress: 0% exposing 0 of 1\n"));
  EXPECT_NE(done({"encode", "--progress", "-f", "100", "still%d.pgm", "e.tik"}).err.find("% encoding "),
            std::string::npos);
  EXPECT_EQ(done({"video", "--out-fps", "100", "scene.tik", "f-%d.png"}).err, "");
}

TEST_F(Farm, TellsByItsStatusWhetherToTryAgain) {
  scratch_.write("list.txt", "--start 9s --exposure 1f late.png\n");
  static_cast<void>(done({"batch", "list.txt", "scene.tik"}, 1));
  scratch_.write("list.txt", "--start 9s --exposure 1f late.png\n--start 0f --exposure 1f absent/e.png\n");
  static_cast<void>(done({"batch", "list.txt", "scene.tik"}, 5));
  static_cast<void>(done({"video", "--frames", "0", "scene.tik", "absent/v-%d.png"}, 5));
  static_cast<void>(done({"video", "--device", "no such device", "scene.tik", "v-%d.png"}, 4));
}

}  // namespace
}  // namespace nutik
