// Many exposures by one command.
#include <gtest/gtest.h>

#include "support/app_test.hpp"

namespace nutik::test {
namespace {

class Batch : public AppTest {
 protected:
  void SetUp() override {
    make_scene();
    scratch_.write("trail.fn", "M0 [0:0], [10000000:1], [40000000:0]\n");
  }
};

TEST_F(Batch, GivesThePicturesOfSingleCommands) {
  scratch_.write("list.txt",
                 "\xEF\xBB\xBF# exposures\n"
                 "\n"
                 "--start 1f --exposure 2f scene.tik moment.png\r\n"
                 "-k trail.fn scene.tik 'a trail.pfm'\n"
                 "   -k trail.fn --depth 16 scene.tik -o trail.tif\n");
  // Singly first: a program that is new on a machine says that it builds kernels.
  make("--start 1f --exposure 2f scene.tik single.png");
  make("-k trail.fn scene.tik single.pfm");
  make("-k trail.fn --depth 16 scene.tik single.tif");
  const ProgramResult batch = make("batch list.txt");
  EXPECT_TRUE(batch.out.starts_with("3 of 3 pictures, ")) << batch.out;
  expect_says(batch.out, " exposures a second on ");
  EXPECT_EQ(batch.err, "");
  EXPECT_EQ(file("moment.png"), file("single.png"));
  EXPECT_EQ(file("a trail.pfm"), file("single.pfm"));
  EXPECT_EQ(file("trail.tif"), file("single.tif"));
}

// Boxcars over many blocks, whose sums are kept from one picture to the next: the first, the last and each by itself
// have the same bytes.
TEST_F(Batch, GivesThePicturesOfSingleCommandsWhereSumsAreKept) {
  for (int k = 0; k < 200; ++k) {
    std::string still = "P5\n9 7\n255\n";
    for (int i = 0; i < 9 * 7; ++i) still += static_cast<char>((k * k * 7 + i * 31 + k * i) % 256);
    scratch_.write("long" + std::to_string(k) + ".pgm", still);
  }
  make("encode -f 100 --block-samples 16 long%d.pgm long.tik");
  std::string lines;
  for (int k = 0; k < 6; ++k) {
    for (const char* type : {"png", "pfm"}) {
      lines += "--start " + std::to_string(30 * k) + "ms --exposure 1.6s many" + std::to_string(k) + "." +
               type + "\n";
    }
  }
  scratch_.write("list.txt", lines);
  const ProgramResult batch = make("batch -v list.txt long.tik");
  expect_says(batch.out, " sums of others kept, ");
  for (int k = 0; k < 6; ++k) {
    for (const std::string type : {".png", ".pfm"}) {
      const std::string one = "one" + type, many = "many" + std::to_string(k) + type;
      ASSERT_EQ(run({"--start", std::to_string(30 * k) + "ms", "--exposure", "1.6s", "long.tik", one,
                     "--overwrite"})
                    .status,
                0);
      EXPECT_EQ(file(many), file(one)) << many;
    }
  }
}

// The last picture has codes from 140 on; four times the light of every code above 137 is above white.
TEST_F(Batch, CountsSaturatedPixelsOfThePicturesThatHoldCodes) {
  scratch_.write("list.txt",
                 "--start 5f --exposure 1f --ev 2 codes.png\n"
                 "--start 5f --exposure 1f --ev 2 light.pfm\n");
  const ProgramResult mixed = run("batch list.txt scene.tik");
  expect_says(mixed.out, ", 63 pixels saturated above 1, ");
  scratch_.write("list.txt", "--start 5f --exposure 1f --ev 2 light.pfm\n");
  const ProgramResult light = run("batch list.txt scene.tik");
  EXPECT_EQ(light.out.find("saturated"), std::string::npos) << light.out;
}

TEST_F(Batch, LeavesTheCaptureToTheCommandAndReadsFromStandardInput) {
  const ProgramResult batch =
      shell("printf '%s\\n' '--start 0f --exposure 1f a.png' '-k trail.fn b.png' | " NUTIK_TEST_PROGRAM
            " batch -f 100 - still%d.pgm");
  EXPECT_TRUE(batch.out.starts_with("2 of 2 pictures, ")) << batch.out;
  make("-f 100 -k trail.fn still%d.pgm single.png");
  EXPECT_EQ(file("b.png"), file("single.png"));
}

TEST_F(Batch, TakesWordsAsAShellDoes) {
  scratch_.write("it's a.fn", "M0 [0:0], [10000000:1], [40000000:0]\n");
  scratch_.write("list",
                 "-k 'it'\\''s a.fn' \"a \\\"b\\\".png\"\n"
                 "\t--functions=\"it's a.fn\" 'c d'.png\n"
                 "-kit\\'s\\ a.fn e\\ f.png\n"
                 "-k 'trail.fn g.png\n");
  const ProgramResult batch = make("batch list scene.tik", 1);
  EXPECT_TRUE(batch.out.starts_with("3 of 4 pictures, ")) << batch.out << batch.err;
  expect_says(batch.err, "list:4: the quote ' is not closed: -k 'trail.fn g.png");
  const std::string first = file("a \"b\".png");
  EXPECT_FALSE(first.empty());
  EXPECT_EQ(first, file("c d.png"));
  EXPECT_EQ(first, file("e f.png"));
}

TEST_F(Batch, KeepsNoRecipesWhereNoneAreWanted) {
  scratch_.write("list", "-k trail.fn a.png\n-k trail.fn --no-recipe b.png\n");
  make("batch list scene.tik");
  make("reproduce a.png");
  make("reproduce b.png", 3);
  make("batch --no-recipe --overwrite list scene.tik");
  make("reproduce a.png", 3);
}

TEST_F(Batch, SharesWhatDescribesTheClip) {
  for (const char* shared :
       {"--fps 100", "-a 90", "--white 200", "--raw 9x7:gray", "--tolerance 1", "--noise auto", "--sigmas 2",
        "--tiles dense", "--block-samples 2", "--device 0", "--memory 1GB", "--json"}) {
    scratch_.write("list", std::string(shared) + " --start 0f --exposure 1f a.png\n");
    const ProgramResult batch = make("batch -f 100 list still%d.pgm", 1);
    expect_says(batch.err, " holds for all exposures: nutik-cl batch --");
  }
}

TEST_F(Batch, ReadsLightAnewInEachLineUnlessNoiseWasToldByIt) {
  make("-f 100 -k trail.fn --transfer gamma:2 still%d.pgm single.png");
  scratch_.write("list", "-k trail.fn --transfer gamma:2 a.png\n");
  make("batch -f 100 --transfer linear list still%d.pgm");
  EXPECT_EQ(file("a.png"), file("single.png"));
  expect_says(make("batch -f 100 --noise auto list still%d.pgm", 1).err,
              "list:1: --transfer holds for all exposures where --noise does");
}

TEST_F(Batch, LeavesSeriesToExpose) {
  scratch_.write("list", "--exposure 10ms --every 10ms s-%d.png\n");
  const ProgramResult batch = make("batch list scene.tik", 1);
  expect_says(batch.err, "list:1: --every and --count make a series; a line of a batch is one picture");
}

TEST_F(Batch, ReportsBadLinesAndGoesOn) {
  scratch_.write("list.txt",
                 "--start 0f --exposure 1f a.png\n"
                 "--start 9s --exposure 1f late.png\n"
                 "--start 0f --exposure 1f a.png\n"
                 "-k absent.fn b.png\n"
                 "--precision single --start 0f --exposure 1f c.png\n"
                 "--exposre 1f d.png\n"
                 "--help\n"
                 "--start 0f --exposure 1f absent/e.png\n"
                 "--start 0f --exposure 1f scene.tik f.png\n"
                 "--start 1f --exposure 1f g.png\n");
  const ProgramResult batch = make("batch list.txt scene.tik", 5);  // one picture could not be written
  EXPECT_TRUE(batch.out.starts_with("2 of 10 pictures, ")) << batch.out;
  expect_says(batch.err, {"list.txt:2: the interval from 9 s on lies outside the capture, which lasts 60 ms",
                          "list.txt:3: a.png is written by line 1 already", "list.txt:4: absent.fn cannot be read: ",
                          "list.txt:5: --precision holds for all exposures: nutik-cl batch --precision single",
                          "list.txt:6: there is no option --exposre; did you mean --exposure?",
                          "list.txt:7: --help is no exposure",
                          "list.txt:8: absent/e.png cannot be created: ", "list.txt:9: 'f.png' is one file too many"});
  EXPECT_FALSE(file("a.png").empty());
  EXPECT_FALSE(file("g.png").empty());
}

TEST_F(Batch, GivesNoPictureOfAnotherLineToOneThatItsFormatCannotHold) {
  scratch_.write("list.txt",
                 "--start 0f --exposure 1f --depth float scene.tik bad.png\n"
                 "--start 1f --exposure 2f scene.tik good.png\n"
                 "--start 2f --exposure 1f scene.tik last.png\n");
  expect_says(make("batch list.txt", 1).err, "list.txt:1: bad.png cannot hold floating point");
  EXPECT_FALSE(exists("bad.png"));
  make("--start 1f --exposure 2f scene.tik single.png");
  EXPECT_EQ(file("good.png"), file("single.png"));
  EXPECT_TRUE(exists("last.png"));
}

// Also where another line reads it, and where its name is one of several.
TEST_F(Batch, ReplacesNoInputAndNoPictureOfAnotherLine) {
  const std::string mask = "P5\n9 7\n255\n" + std::string(9 * 7, '\0');
  for (const char* name : {"early.pgm", "late.pgm"}) scratch_.write(name, mask);
  for (const char* folder : {"d1", "d2"}) std::filesystem::create_directory(scratch_ / folder);
  std::filesystem::create_directory_symlink("d1", scratch_ / "d3");
  std::filesystem::create_symlink("../d1/x.png", scratch_ / "d2/x.png");
  scratch_.write("list.txt",
                 "-k trail.fn -m early.pgm a.png\n"
                 "--start 1f --exposure 1f d1/../late.pgm\n"
                 "--start 1f --exposure 1f early.pgm\n"
                 "--start 0f --exposure 1f d1/x.png\n"
                 "--start 1f --exposure 1f d2/x.png\n"
                 "--start 2f --exposure 1f d3/x.png\n"
                 "-k trail.fn -m d3/../late.pgm b.png\n");
  const ProgramResult batch = make("batch --overwrite list.txt scene.tik", 1);
  expect_says(batch.err,
              {"list.txt:2: d1/../late.pgm is an input of line 7; choose another name",
               "list.txt:3: early.pgm is an input of line 1;", "list.txt:5: d2/x.png is written by line 4 already",
               "list.txt:6: d3/x.png is written by line 4 already"});
  EXPECT_TRUE(batch.out.starts_with("3 of 7 pictures, ")) << batch.out;
  for (const char* name : {"early.pgm", "late.pgm"}) EXPECT_EQ(file(name), mask) << name;
  EXPECT_TRUE(std::filesystem::is_symlink(scratch_ / "d2/x.png"));
}

TEST_F(Batch, RefusesListsThatListNothing) {
  make("batch", 2);
  make("batch absent.txt", 3);
  scratch_.write("empty.txt", "# nothing\n");
  expect_refused("batch empty.txt", 3, "empty.txt lists no exposure");
}

}  // namespace
}  // namespace nutik::test
