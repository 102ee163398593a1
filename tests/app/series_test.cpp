// Series of exposures through the program.
#include <gtest/gtest.h>

#include "support/app_test.hpp"
#include "support/still_clip.hpp"

namespace nutik::test {
namespace {

class Series : public AppTest {
 protected:
  void SetUp() override {
    write_still_clip(scratch_.folder(), 24, 40);
    run("-f 40 -a 180 frames clip.tik");
  }
  ProgramResult run(const Words& words) const { return make(test::over(words)); }
  // How many of name-0, name-1, … there are.
  [[nodiscard]] int written(const std::string& name) const {
    int count = 0;
    while (exists(name + "-" + std::to_string(count) + ".pfm")) ++count;
    return count;
  }
};

TEST_F(Series, IsTheSinglePictures) {
  for (const std::string renderer : {"opencl", "reference"}) {
    for (const std::string input : {"clip.tik", "frames"}) {
      const Words common = "--exposure 60ms --shutter hann --renderer " + renderer + " " + input +
                           (input == "frames" ? " -f 40 -a 180" : "");
      run("--start 0.01s --every 1/3s --count 3 -o s-%d.pfm" + common);
      const char* starts[] = {"10ms", "343333333ns", "676666667ns"};
      for (int k = 0; k < 3; ++k) {
        run(Words{"-o", "single.pfm", "--start", starts[k]} + common);
        EXPECT_EQ(file("single.pfm"), file("s-" + std::to_string(k) + ".pfm"))
            << renderer << ", " << input << ", " << k;
      }
    }
  }
}

TEST_F(Series, MovesFunctionsAndKeepsTheMask) {
  scratch_.write("f.fn",
                 "M0 [0:1], [50000000:0]\nM9 [10000000:0], [60000000:2], [60000001:-1], [90000000:0]\n");
  scratch_.write("moved.fn",
                 "M0 [249999999:0], [250000000:1], [300000000:0]\n"
                 "M9 [260000000:0], [310000000:2], [310000001:-1], [340000000:0]\n");
  std::string mask = "P2 24 24 255\n";
  for (int i = 0; i < 24 * 24; ++i) mask += i % 5 == 0 ? "9 " : "0 ";
  scratch_.write("mask.pgm", mask);
  run("-k f.fn -m mask.pgm --every 125ms clip.tik k-%d.pfm");
  EXPECT_EQ(written("k"), 8);  // the last one's last point lies at 875 + 90 ms
  run("-k f.fn -m mask.pgm --start 250ms clip.tik single.pfm");
  EXPECT_EQ(file("single.pfm"), file("k-2.pfm"));
  // A function that is held at 1 before its first point is held there, too, when it has moved.
  run("-k moved.fn -m mask.pgm clip.tik moved.pfm");
  const auto moved = read_pfm(scratch_ / "moved.pfm"), second = read_pfm(scratch_ / "k-2.pfm");
  int alike = 0, pixels = 0;
  for (int i = 0; i < 24 * 24; ++i) {
    if (i % 5 != 0) continue;  // M9
    const std::size_t bottom_up = static_cast<std::size_t>((23 - i / 24) * 24 + i % 24);
    ++pixels;
    alike += moved[bottom_up] == second[bottom_up];
  }
  EXPECT_EQ(alike, pixels);
}

// 1/300 s + 1001/90000 s = 14455555.56 ns; the two rounded first would be 14455555 ns.
TEST_F(Series, RoundsEachStartOnce) {
  const auto answer =
      run("--start 1/300s --exposure 1ms --every 1001/90000s --count 3 --json clip.tik r-%d.pfm");
  for (const char* start : {"1/300s", "1301/90000s", "1151/45000s"})
    EXPECT_NE(answer.out.find('"' + std::string(start) + '"'), std::string::npos)
        << start << " in " << answer.out;
  const auto rounded = run("--start 14455556ns --exposure 1ms clip.tik rounded.pfm");
  EXPECT_EQ(file("rounded.pfm"), file("r-1.pfm")) << "14455555.56 ns to 15455555.56 ns";
}

TEST_F(Series, CountsInPicturesOfTheClip) {
  run("--start 3f --exposure 1f --every 10f clip.tik f-%d.pfm");
  EXPECT_EQ(written("f"), 4);
  for (int k = 0; k < 4; ++k) {
    run({"--start", std::to_string(3 + 10 * k) + "f", "--exposure", "1f", "clip.tik", "single.pfm"});
    EXPECT_EQ(file("single.pfm"), file("f-" + std::to_string(k) + ".pfm")) << k;
  }
}

TEST_F(Series, HasAsManyAsFit) {
  run("--exposure 25ms --every 25ms clip.tik a-%d.pfm");
  EXPECT_EQ(written("a"), 40);
  run("--exposure 26ms --every 25ms clip.tik b-%d.pfm");
  EXPECT_EQ(written("b"), 39);
  scratch_.write("step.fn", "M0 [0:1], [25ms:1], [25000001:0]\n");  // steps down as the clip ends
  run("-k step.fn --every 25ms clip.tik d-%d.pfm");
  EXPECT_EQ(written("d"), 40);
  const auto result = run("--exposure 100ms --every 300ms clip.tik");
  for (const char* name : {"clip-0s-100ms-0000.png", "clip-0s-100ms-0003.png"}) {
    EXPECT_TRUE(exists(name)) << name;
  }
  expect_says(result.out, "clip-0s-100ms-0000.png … clip-0s-100ms-0003.png: 4 exposures every 300ms");
  // --count may go on behind the end: that is said, once.
  const auto over = run("--start 0.9s --exposure 200ms --every 50ms --count 2 clip.tik c-%d.pfm");
  EXPECT_EQ(over.err,
            "warning: c-0.pfm and 1 more: the exposure: parts that are not zero lie after the capture's end "
            "at 1 s and do "
            "not count\n");
}

// Who reads a folder's numbers on would take them for this series.
TEST_F(Series, TellsOfOlderPicturesBehindItsLast) {
  EXPECT_EQ(run("--every 4f --count 6 --exposure 1f clip.tik s-%d.pfm").err, "");
  const auto shorter = [&](const Words& words) { return run(words + "clip.tik s-%d.pfm").err; };
  const std::string older = "s-3.pfm … s-5.pfm were there before and are no part of this series";
  expect_says(shorter({"--every", "8f", "--count", "3", "--exposure", "1f"}), older);
  expect_says(shorter({"video", "--out-fps", "20", "--to", "0.15s"}), older);
  // A part of a series leaves the others to whoever makes them.
  EXPECT_EQ(shorter({"--every", "4f", "--count", "6", "--frames", "0-2", "--exposure", "1f"}), "");
  EXPECT_EQ(written("s"), 6);
}

TEST_F(Series, RefusesNamesThatAreTooLong) {
  for (const char* name : {"s-%300d.pfm", "s-%0300d.pfm", "s-%99999999999999999999d.pfm"}) {
    expect_refused({"--every", "4f", "--exposure", "1f", "clip.tik", name}, 5, "File name too long");
  }
}

TEST_F(Series, TellsItsWarningsAlsoWhereItEndsInAnError) {
  run("-f 40 --block-samples 10 --codec none frames blocks.tik");
  std::string capture = file("blocks.tik");
  capture[capture.size() * 8 / 10] ^= 0x55;  // in one of the later blocks
  scratch_.write("blocks.tik", capture);
  scratch_.write("held.fn", "M0 [0:1], [20000000:1], [20000001:0]\n");
  const ProgramResult result = make({"-k", "held.fn", "--every", "4f", "blocks.tik", "-o", "d-%d.pfm"}, 3);
  EXPECT_GT(written("d"), 1);
  expect_says(result.err, "warning: d-1.pfm");
  EXPECT_LT(result.err.find("warning: d-1.pfm"), result.err.find("is damaged")) << result.err;
}

// Blocks are checked side by side.
TEST_F(Series, NamesTheFirstOfTwoDamagedBlocks) {
  run("-f 40 --block-samples 4 --codec none frames blocks.tik");
  std::string capture = file("blocks.tik");
  for (const std::size_t eighths : {3, 6}) capture[capture.size() * eighths / 8] ^= 0x55;
  scratch_.write("blocks.tik", capture);
  const auto refusal = [&](const char* from) {
    return make({"expose", "--start", from, "--exposure", "10s", "blocks.tik", "a.pfm", "--overwrite"}, 3).err;
  };
  const std::string first = refusal("0s");
  expect_says(first, "is damaged");
  for (int times = 0; times < 4; ++times) EXPECT_EQ(refusal("0s"), first);
  EXPECT_NE(refusal("0.6s"), first);  // behind the first of them
}

TEST_F(Series, SaysWhatIsWrongBeforeItWrites) {
  const Words plain("--exposure 25ms clip.tik");
  expect_refused(
      2, {{plain + "--every 1s -o out.pfm", "needs a number in its pictures' name, as in out-%03d.pfm"},
          {plain + "--every 1s -o o-%d-%d.pfm", "o-%d-%d.pfm has a place for two numbers"},
          {plain + "--every 0s -o o%d.pfm", "every '0s' is not longer than nothing"},
          {plain + "--every 1.5f -o o%d.pfm", "is not a whole number of pictures"},
          {plain + "--every 40 -o o%d.pfm", "every '40' is no time"},
          {plain + "--every 1s --count 0 -o o%d.pfm", "--count '0' is no whole number of 1 … 1000000"},
          {plain + "--count 3 -o o%d.pfm", "--count goes with --every"},
          {plain + "--every 300ms --count 5 -o o%d.pfm",
           "exposure 4 of the series would start at 1.2 s, behind the end of the capture at 1 s; "
           "--count 4 at most"},
          {plain + "--start 2s --every 1s -o o%d.pfm", "the series starts at 2 s, behind the end"},
          {"--exposure 2s --every 1s clip.tik o%d.pfm", "not one exposure of the series ends within the capture"}});
  scratch_.write("o3.pfm", "notes of mine");
  expect_refused(plain + "--every 100ms -o o%d.pfm", 2, "o3.pfm exists and is no picture; it is not replaced");
  EXPECT_FALSE(exists("o0.pfm"));
  EXPECT_EQ(file("o3.pfm"), "notes of mine");
  expect_refused("-f 40 --exposure 25ms --every 100ms frames -o frames/%03d.pgm", 2, "is also an input");
}

}  // namespace
}  // namespace nutik::test
