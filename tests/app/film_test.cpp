// Films whose functions, masks and speed change, as the program makes them: pixels worked out by hand, and frames that
// are made again from their recipes.
#include <gtest/gtest.h>

#include "support/app_test.hpp"
#include "support/clips.hpp"

namespace nutik::test {
namespace {

constexpr int kFilmWidth = 8, kFilmHeight = 8, kFilmSamples = 10;

// Ten pictures, a tenth of a second each; picture k has the linear code 10 (k + 1) everywhere.
class Film : public AppTest {
 protected:
  void SetUp() override {
    write_frames(kFilmSamples,
                 [](int k) { return cv::Mat(kFilmHeight, kFilmWidth, CV_8UC1, cv::Scalar::all(10 * (k + 1))); });
    make("-f 10 --transfer linear frames c.tik -q");
  }

  // The codes of the first row of every frame, as the capture has them.
  std::vector<std::vector<int>> rows(const Words& options) const {
    std::filesystem::remove_all(scratch_ / "out");
    std::filesystem::create_directory(scratch_ / "out");
    make("video" + options + "--out-fps 10 --out-transfer source -q c.tik out/%02d.pgm");
    std::vector<std::vector<int>> rows;
    for (const auto& raster : read_all(*open_test_clip(scratch_ / "out/%02d.pgm"))) {
      rows.emplace_back();
      for (int x = 0; x < kFilmWidth; ++x) rows.back().push_back(static_cast<int>(raster[static_cast<std::size_t>(x)]));
    }
    return rows;
  }
  std::vector<int> codes(const Words& options) const {
    std::vector<int> codes;
    for (const auto& row : rows(options)) {
      EXPECT_EQ(row, std::vector<int>(kFilmWidth, row[0]));
      codes.push_back(row[0]);
    }
    return codes;
  }

  // The columns left of `edge` have mask value 255.
  void write_mask(const std::string& name, int edge) const {
    std::string mask = "P5 8 8 255\n";
    for (int i = 0; i < kFilmWidth * kFilmHeight; ++i) mask += i % kFilmWidth < edge ? '\xff' : '\0';
    scratch_.write(name, mask);
  }
  // A boxcar that begins `start` tenths of a second after a frame's start and lasts `length` of them.
  static std::string boxcar(const std::string& name, int start, int length) {
    const std::int64_t tenth = 100'000'000, from = start * tenth, to = from + length * tenth;
    return name + " [" + std::to_string(from - 1) + ":0], [" + std::to_string(from) + ":1], [" + std::to_string(to) +
           ":1], [" + std::to_string(to + 1) + ":0]\n";
  }
  void write_two_masks_and_functions() const {
    write_mask("a.pgm", 2);
    write_mask("b.pgm", 6);
    scratch_.write("f.fn", boxcar("M0", 0, 1) + boxcar("M255", 1, 1));
  }

  // Every frame is what its recipe makes; returns the last one's.
  std::string expect_all_made_again(const std::string& pattern, int count) const {
    std::string command;
    for (int k = 0; k < count; ++k) command = expect_made_again(pattern + std::to_string(k) + ".png");
    return command;
  }
};

TEST_F(Film, FollowsACurveOfSpeed) {
  scratch_.write("ramp.csv", "# film, capture\n0s,0s\n0.5s,1s\n1s,1s\n1.5s,0s\n");
  EXPECT_EQ(codes("--curve ramp.csv --out-angle 360"),
            (std::vector<int>{15, 35, 55, 75, 95,       // twice as fast: the mean of two pictures
                              100, 100, 100, 100, 100,  // still, at the end
                              95, 75, 55, 35, 15}));    // backwards
  scratch_.write("slow.csv", "0f,2f\n4f,4f\n");
  EXPECT_EQ(codes("--curve slow.csv"), (std::vector<int>{30, 30, 40, 40}));
  scratch_.write("out.csv", "0s,0.8s\n0.4s,1.2s\n");
  const ProgramResult outside = make("video --curve out.csv --out-fps 10 c.tik o-%d.png");
  expect_says(outside.err,
              "warning: out.csv leaves the capture, which lasts 1 s, in frames 2-3; there the film "
              "shows what is left within it, or stands still");
  expect_says(outside.out, "4 frames (10 frames a second, 180 degrees, by out.csv), from 800 ms to 1 s");
  expect_all_made_again("o-", 4);
}

// The first key exposes 100 ms and the second, 400 ms of the film later, 300 ms: control points move between them.
TEST_F(Film, ChangesFunctionsFromKeyToKey) {
  scratch_.write("a.fn", boxcar("M0", 0, 1));
  scratch_.write("b.fn", boxcar("M0", 0, 3));
  const std::vector<int> expected{10, 23,  // 70 / 3
                                  35, 48,  // 40, 50 and half of 60, over 2.5
                                  60, 70, 80};
  EXPECT_EQ(codes("--key 0s a.fn --key 0.4s b.fn"), expected);
  EXPECT_EQ(codes("--key 0f a.fn --key 4f b.fn"), expected);
  make("video --key 0s a.fn --key 4f b.fn --out-fps 10 --normalize integral c.tik k-%d.png -q");
  expect_says(expect_all_made_again("k-", 7), " -k k-6-again/k-6.fn ");
  EXPECT_EQ(file("k-1-again/k-1.fn"), "M0 [-1:0], [0:1], [150000000:1], [150000001:0]\n");
}

TEST_F(Film, MovesTheEdgesOfAMask) {
  write_two_masks_and_functions();
  const auto got = rows("--mask-key 0s a.pgm --mask-key 0.4s b.pgm -k f.fn");
  ASSERT_EQ(got.size(), 8u);
  for (int k = 0; k < 8; ++k) {
    std::vector<int> expected(kFilmWidth, 10 * (k + 1));
    for (int x = 0; x < std::min(2 + k, 6); ++x) expected[static_cast<std::size_t>(x)] = 10 * (k + 2);
    EXPECT_EQ(got[static_cast<std::size_t>(k)], expected) << k;
  }
  make("video --mask-key 0s a.pgm --mask-key 4f b.pgm --feather 1px -k f.fn --out-fps 10 c.tik m-%d.png -q");
  expect_all_made_again("m-", 8);
  const std::string between = make("reproduce m-1.png").out;
  expect_says(between, {" -m a.pgm --mask-to b.pgm ", " --mask-blend distance --mask-share 0.25 "});
  const std::string at_key = make("reproduce m-4.png").out;
  expect_says(at_key, " -m b.pgm ");
  EXPECT_EQ(at_key.find("--mask-"), std::string::npos) << at_key;
}

TEST_F(Film, FadesOneMaskIntoTheOther) {
  write_two_masks_and_functions();
  const auto got = rows("--mask-key 0s a.pgm --mask-key 0.4s b.pgm --mask-blend alpha -k f.fn");
  // In frame 2, columns 2 to 5 have halves of both functions: 30 and 40.
  ASSERT_EQ(got.size(), 8u);
  EXPECT_EQ(got[2], (std::vector<int>{40, 40, 35, 35, 35, 35, 30, 30}));
  make("video --mask-key 0s a.pgm --mask-key 4f b.pgm --mask-blend alpha --feather 1px -k f.fn --out-fps 10 "
      "c.tik m-%d.png -q");
  expect_all_made_again("m-", 8);
}

// What a frame's recipe says, validate, check and trace take too.
TEST_F(Film, FramesAreExposuresForOtherCommands) {
  write_two_masks_and_functions();
  const Words between("-m a.pgm --mask-to b.pgm --mask-share 0.25 -k f.fn");
  expect_says(make("validate --runs 1 --start 0.1s c.tik" + between).out, "fixed");
  expect_says(make("trace --pixel 2,0 c.tik" + between).out, "M255");
  make("check c.tik" + between);
  write_mask("none.pgm", 0);
  const ProgramResult missing = make("check -m a.pgm --mask-to none.pgm --mask-share 1/2 -k f.fn c.tik", 3);
  expect_says((missing.out + missing.err), "mask value 255 is in a.pgm and not in none.pgm");
  expect_refused(2, {{"--mask-share 0.5 --start 0s --exposure 1f c.tik p.png", "add --mask-to"},
                     {"--mask-blend alpha --start 0s --exposure 1f c.tik p.png", "a second one: add --mask-to"},
                     {"check --mask-blend alpha c.tik", "a second one: add --mask-to"},
                     {"--unmapped zero --start 0s --exposure 1f c.tik p.png", "add -m mask.pgm"},
                     {"--shutter-error 0.1 --start 0s --exposure 1f c.tik p.png", "add --shutter hann"},
                     {"--mask-share nan --start 0s --exposure 1f c.tik p.png", "--mask-share 'nan'"}});
}

// At either end of the way it is one of both masks that is exposed, and of that alone it may be said that a value is
// not in it.
TEST_F(Film, CheckNamesTheMaskThatIsExposed) {
  write_two_masks_and_functions();
  write_mask("none.pgm", 0);
  const auto checked = [&](const std::string& share, const std::string& blend) {
    return make({"check", "-m", "a.pgm", "--mask-to", "none.pgm", "--mask-share", share, "--mask-blend", blend, "-k",
                "f.fn", "c.tik"})
        .out;
  };
  for (const std::string share : {"0", "1/2"}) {
    const std::string out = checked(share, "alpha");
    EXPECT_EQ(out.find("has the value 255"), std::string::npos) << out;
  }
  const std::string at_end = checked("1", "alpha");
  expect_says(at_end, {"M255: no pixel of none.pgm has the value 255", "none.pgm: 8 x "});

  scratch_.write("three.fn", "M0 [0:1], [10:1], [11:0]\nM7 [0:1], [10:1], [11:0]\nM255 [0:1], [10:1], [11:0]\n");
  const std::string between = make("check -m a.pgm --mask-to b.pgm --mask-share 1/2 -k three.fn c.tik").out;
  expect_says(between, "no pixel of a.pgm on its way to b.pgm has the value 7");
}

TEST_F(Film, MadeInPartsHasTheFramesOfTheWhole) {
  write_two_masks_and_functions();
  scratch_.write("a.fn", boxcar("M0", 0, 1) + boxcar("M255", 1, 1));
  scratch_.write("b.fn", boxcar("M0", 0, 2) + boxcar("M255", 0, 1));
  scratch_.write("ramp.csv", "0s,0s\n0.5s,0.7s\n0.8s,0.1s\n");
  const Words film(
      "video --key 0s a.fn --key 0.6s b.fn --mask-key 0s a.pgm --mask-key 7f b.pgm --curve ramp.csv "
      "--out-fps 10 -q c.tik");
  const auto make_frames = [&](const std::string& folder, const Words& frames) {
    std::filesystem::create_directory(scratch_ / folder);
    make(film + (folder + "/%02d.png") + frames);
  };
  make_frames("whole", {});
  for (const char* frames : {"6", "0-2", "4-5 7", "3,5-100x2"}) make_frames("parts", {"--frames", frames});
  for (int k = 0; k < 8; ++k) {
    const std::string name = "/0" + std::to_string(k) + ".png";
    ASSERT_FALSE(file("whole" + name).empty()) << k;
    EXPECT_TRUE(file("whole" + name) == file("parts" + name)) << k;
  }
  EXPECT_FALSE(exists("whole/08.png"));
  EXPECT_FALSE(exists("parts/09.png"));
  // A container has the frames alone.
  make(film + "part.mkv --frames 2-4");
  const auto part = read_all(*open_test_clip(scratch_ / "part.mkv"));
  ASSERT_EQ(part.size(), 3u);
  const auto whole = read_all(*open_test_clip(scratch_ / "whole/%02d.png"));
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(part[k], whole[2 + k]) << k;
}

TEST_F(Film, SaysWhatMakesNoSense) {
  write_two_masks_and_functions();
  write_mask("large.pgm", 3);
  scratch_.write("large.pgm", "P5 9 8 255\n" + std::string(72, '\0'));
  scratch_.write("third.pgm", "P5 8 8 255\n" + std::string(64, '\3'));
  scratch_.write("one.fn", boxcar("M0", 0, 1));
  scratch_.write("other.fn", boxcar("M0", 0, 1) + boxcar("M9", 0, 1));
  scratch_.write("bad.fn", "M0 [0:1], [0:2]\n");
  scratch_.write("ramp.csv", "0s,0s\n1s,1s\n");
  scratch_.write("back.csv", "0s,0s\n1s,1s\n0.5s,0s\n");
  struct Case {
    Words words;
    int status;
    const char* part;
  };
  const Case cases[] = {
      {{"--key", "0s", "one.fn"}, 2, "one.fn is the only key of functions"},
      {{"--key", "1s", "one.fn", "--key", "0s", "one.fn"}, 2, "is not after one.fn at 1 s; keys are in order of time"},
      {{"--key", "1s", "one.fn", "--key", "10f", "one.fn", "--out-fps", "10"}, 2, "is not after one.fn at 1 s"},
      {{"--key", "0s", "one.fn", "--key", "1s", "other.fn", "-m", "a.pgm"}, 3, "other.fn has a function M9 and one.fn"},
      {{"--key", "0s", "one.fn", "--key", "1s", "bad.fn"}, 3, "bad.fn:1:12: time 0 stands twice"},
      {{"--key", "0s", "one.fn", "--key", "1s", "none.fn"}, 3, "none.fn"},
      {{"--key", "-1s", "one.fn", "--key", "1s", "one.fn"}, 2, "--key -1s lies before the film"},
      {{"--key", "1.5f", "one.fn", "--key", "9f", "one.fn"}, 2, "--key 1.5f is no frame of a film"},
      {{"--key", "0s", "-", "--key", "1s", "one.fn"}, 2, "--key 0s - would read standard input"},
      {{"--key", "0s", "one.fn", "--key", "1s", "one.fn", "-k", "one.fn"}, 2, "-k is one file of functions"},
      {{"--key", "0s", "one.fn", "--key", "1s", "one.fn", "--out-angle", "90"}, 2, "--out-angle describes plain"},
      {{"--key", "0s", "f.fn", "--key", "1s", "f.fn"}, 2, "holds 2 functions; a mask says where each applies"},
      {{"--mask-key", "0s", "a.pgm", "--mask-key", "1s", "b.pgm"}, 2, "a mask goes with gain functions"},
      {{"--mask-key", "0s", "a.pgm", "-k", "f.fn"}, 2, "a.pgm is the only key of masks"},
      {{"--mask-key", "0s", "a.pgm", "--mask-key", "1s", "b.pgm", "-k", "f.fn", "-m", "a.pgm"}, 2, "-m is one mask"},
      {{"--mask-key", "0s", "a.pgm", "--mask-key", "1s", "large.pgm", "-k", "f.fn"}, 3, "9 x 8"},
      {{"--mask-blend", "alpha"}, 2, "--mask-blend says how masks change; add --mask-key"},
      {{"--mask-key", "0s", "a.pgm", "--mask-key", "1s", "b.pgm", "-k", "f.fn", "--mask-blend", "fast"},
       2,
       "--mask-blend 'fast' is not known; choose distance or alpha"},
      {{"--mask-key", "0s", "a.pgm", "--mask-key", "1s", "third.pgm", "-k", "f.fn", "--mask-blend", "alpha"},
       3,
       "third.pgm: mask value 3 has no function; add M3, or --unmapped zero"},
      {{"--curve", "ramp.csv", "--speed", "2"}, 2, "--speed says what of the capture the film shows, and so does"},
      {{"--curve", "ramp.csv", "--from", "0s"}, 2, "--from says what"},
      {{"--curve", "back.csv"}, 3, "back.csv:3: the film's time 500 ms is not after 1 s"},
      {{"--curve", "none.csv"}, 3, "none.csv"},
      {{"--frames", "1-"}, 2, "--frames '1-': '1-' is no range of frames"},
      {{"--frames", "24-30"}, 2, "none of the frames 24-30 is there: the film has 24, numbered from 0 to 23"},
  };
  for (const Case& tested : cases) {
    expect_refused("video c.tik v-%d.png" + tested.words, tested.status, tested.part);
    EXPECT_FALSE(exists("v-0.png"));
  }
  const auto expose = [&](const Words& words) { return make(words + "c.tik e.png", 2).err; };
  expect_says(expose({"-m", "a.pgm", "--mask-to", "b.pgm", "-k", "f.fn"}), "Add --mask-share 1/2");
  expect_says(expose({"-m", "a.pgm", "--mask-to", "b.pgm", "--mask-share", "1.5", "-k", "f.fn"}),
              "--mask-share 1.5 is no share of 0 to 1");
  expect_says(expose({"-m", "a.pgm", "--mask-share", "1", "-k", "f.fn"}), "add --mask-to");
  expect_says(expose({"--mask-to", "b.pgm", "--mask-share", "1", "-k", "one.fn"}), "add the first: -m");
  // An input that a still would replace.
  make("video --mask-key 0s a.pgm --mask-key 1s b.pgm -k f.fn c.tik --frames 0 -o %d.pgm");
  scratch_.write("1.pgm", file("b.pgm"));
  expect_says(make("video --mask-key 0s a.pgm --mask-key 1s 1.pgm -k f.fn c.tik -o %d.pgm", 2).err,
              "the output 1.pgm is also an input");
}

}  // namespace
}  // namespace nutik::test
