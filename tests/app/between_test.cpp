// Samples made between pictures, from the command line: what is told of them, and what is refused.
#include <gtest/gtest.h>

#include <cmath>

#include "capture/format.hpp"
#include "support/app_test.hpp"

namespace nutik::test {
namespace {

class BetweenPictures : public AppTest {
 protected:
  static constexpr int kWidth = 128, kHeight = 80, kPictures = 4;

  // A textured square that moves six pixels a picture over textured ground.
  void SetUp() override {
    std::filesystem::create_directory(scratch_ / "frames");
    for (int k = 0; k < kPictures; ++k) {
      std::string picture = "P5\n128 80\n255\n";
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          const int u = x - 20 - 6 * k, v = y - 25;
          const bool is_square = u >= 0 && u < 30 && v >= 0 && v < 30;
          const double code = is_square ? 190 + 40 * std::sin(0.6 * u) * std::cos(0.5 * v)
                                        : 80 + 25 * std::sin(0.4 * x + 0.2 * y) * std::cos(0.33 * y);
          picture += static_cast<char>(std::lround(code));
        }
      }
      scratch_.write("frames/" + std::to_string(k) + ".pgm", picture);
    }
  }
};

TEST_F(BetweenPictures, AreMarkedWhereverTheyAreTold) {
  const auto encoded = make("encode -f 20 --transfer srgb --between auto frames all.tik");
  expect_says(encoded.out, "21 samples made along the motion between 4 filmed");
  const auto info = answer("info all.tik");
  EXPECT_EQ(info["samples"], 25);
  EXPECT_EQ(info["made_samples"]["after"], (std::vector<int>{7, 7, 7, 0}));
  expect_says(run("info all.tik").out, "21 samples made along the motion between 4 filmed");
  make("--between off --start 0s --exposure 50ms all.tik off.png");  // which asks for nothing
  expect_refused("--between auto --start 0s --exposure 50ms all.tik off.png", 2, "--between describes a clip");
  expect_says(make("validate --runs 1 --start 0f --exposure 1f --source frames all.tik").out,
              {"frames: held exactly; ", "; 21 samples made between its pictures not compared"});
  const Words trace("trace --pixel 50,40 --start 0s --exposure 200ms all.tik");
  expect_says(run(trace).out, " made");
  make(trace + "steps.csv");
  expect_says(file("steps.csv"), ",is_made\n");
  // The steps that begin with what was filmed have no mark.
  bool is_filmed = false, is_made = false;
  const auto told = answer(trace);
  for (const auto& step : told["steps"]) (step.contains("is_made") ? is_made : is_filmed) = true;
  EXPECT_TRUE(is_filmed && is_made);
}

TEST_F(BetweenPictures, AreCountedWhereTheyWereSaved) {
  make("encode -f 20 --transfer srgb --from 1f --between 3 --block-samples 2 --codec none frames all.tik");
  const std::string bytes = file("all.tik");
  scratch_.write("cut.tik", std::string_view(bytes).substr(0, bytes.size() * 3 / 4));
  const std::uint64_t samples = answer("recover cut.tik whole.tik")["samples"], filmed = (samples + 3) / 4;
  EXPECT_LT(samples, 9u);
  expect_says(make("info whole.tik").out, {format("{} samples made along the motion between {} filmed; ",
                                                  samples - filmed, filmed),
                                           format("taken for   pictures 1 … {} of 4, ", filmed)});
}

TEST_F(BetweenPictures, JoinWhatFramesOfAVideoWouldShowTwice) {
  const Words film("video -f 20 --transfer srgb --out-angle 360 --overwrite frames %d.png --out-fps 10");
  const std::string note = "samples are looked for between pictures 0 … 3, which takes most of the time; --between off";
  const auto joined = make(film);
  expect_says(joined.err, note);
  expect_says(run("reproduce 0.png").out, "--between auto:0f..3f");
  const std::string picture = file("0.png");
  make(film + "--between auto");
  EXPECT_TRUE(file("0.png") != picture) << "their recipes differ";
  make(film + "--between auto:0f..3f");
  EXPECT_TRUE(file("0.png") == picture);
  EXPECT_EQ(make(film + "--between off").err.find(note), std::string::npos);
  EXPECT_EQ(make("video -f 20 --out-angle 360 --out-fps 20 --overwrite frames %d.png").err.find(note),
            std::string::npos);
  // A capture has what it was encoded with.
  make("encode -f 20 --transfer srgb frames filmed.tik");
  EXPECT_EQ(make("video --out-fps 10 --out-angle 360 --overwrite filmed.tik %d.png").err.find(note), std::string::npos);
}

TEST_F(BetweenPictures, AreSaidToBeMissingWhereAFilmCannotHaveThem) {
  std::filesystem::create_directory(scratch_ / "large");
  for (int k = 0; k < kPictures; ++k)
    scratch_.write("large/" + std::to_string(k) + ".pgm", "P5 512 320 255\n" + std::string(512 * 320, 'a'));
  const auto film = make("video -f 20 --memory 20MB --out-angle 360 --out-fps 10 large %d.png");
  expect_says(film.err, "note: frames show what moves two or three times: samples cannot be made: ");
  EXPECT_EQ(film.err.find("samples are looked for"), std::string::npos) << film.err;
  EXPECT_EQ(run("reproduce 0.png").out.find("--between"), std::string::npos);
}

// As it is in the end, however far they had come.
TEST_F(BetweenPictures, AreSaidToBeMissingAloneWhereTheDiskIsFull) {
  std::filesystem::create_directory(scratch_ / "tmp");
  const auto library = std::filesystem::path(NUTIK_TEST_PROGRAM).parent_path() / "tests" / "libfail_calls.so";
  const auto film =
      shell(format("TMPDIR=tmp LD_PRELOAD='{}' NUTIK_FAIL_FOLDER='{}' NUTIK_FAIL_CALL=write NUTIK_FAIL_AT=12 "
                   "NUTIK_FAIL_ERROR=28 '{}' video -f 20 --out-angle 360 --out-fps 10 frames %d.png",
                   library.string(), (scratch_ / "tmp").string(), NUTIK_TEST_PROGRAM));
  expect_says(film.err, "samples cannot be made: ");
  EXPECT_EQ(film.err.find("leaves them out"), std::string::npos) << film.err;
}

TEST_F(BetweenPictures, AreMadeOnlyWhereAnIntervalInSecondsLies) {
  const Words source("-f 20 --transfer srgb --start 60ms --exposure 30ms --no-recipe frames");
  make(source + "--between 3 part.pfm");
  make(source + "--between 3:0f..3f all.pfm");
  EXPECT_TRUE(file("part.pfm") == file("all.pfm"));
  expect_says(run("-f 20 --between 3 --start 60ms --exposure 30ms frames part.png").out, "between 4 filmed");
  expect_says(run("reproduce part.png").out, "--between 3 ");
  make("-f 20 --between 3 --to 1f --start 0s --exposure 30ms frames single.png");
}

TEST_F(BetweenPictures, AreCountedByNoTime) {
  const Words clip("-f 20 --transfer srgb --between 3 frames");
  make("encode" + clip + "-o all.tik");
  make("encode -f 20 --transfer srgb frames filmed.tik");
  const std::vector<Words> sources{clip, Words("all.tik")};
  for (const Words& source : sources) {
    const auto same = [&](const Words& command, const Words& pictures, const Words& seconds, const std::string& name) {
      make(command + pictures + source + "-o" + name + "--overwrite");
      const std::string made = file(name);
      make(command + seconds + source + "-o" + name + "--overwrite");
      EXPECT_TRUE(made == file(name));
    };
    const Words expose("expose --renderer reference --no-recipe");
    same(expose, "--start 1f --exposure 2f", "--start 50ms --exposure 100ms", "p.pfm");
    same(expose, "--start 20ms --exposure 2f", "--start 20ms --exposure 100ms", "p.pfm");
    same("mask", "--subject 2f", "--subject 125ms", "m.pgm");
    same("mask", "--changed-between 1f 2f", "--changed-between 75ms 125ms", "m.pgm");
    EXPECT_EQ(answer("video --from 1f --to 3f --out-fps 20 --overwrite" + source + "-o f%d.png")["frames"], 2);
    EXPECT_EQ(answer("contact --overwrite" + source + "-o sheet.png")["exposures"],
              answer("contact --overwrite filmed.tik sheet.png")["exposures"]);
    EXPECT_EQ(answer("expose --every 2f --exposure 1f --overwrite" + source + "-o s%d.png")["pictures"].size(), 2u);
    const std::string moment = run("activity --moment busiest" + source).out;
    EXPECT_EQ(moment.find("f "), std::string::npos) << "stretches of samples are told in seconds: " << moment;
  }
  expect_says(run("info all.tik").out, "--start 2f --exposure 1f all.tik");
  scratch_.write("curve.csv", "0s,1f\n100ms,3f\n");
  const Words film("video --curve curve.csv --out-fps 20 --out-angle 360 all.tik c%d.png");
  EXPECT_EQ(answer(film)["end_ns"], 150'000'000);
  expect_refused("--start 4f --exposure 1f all.tik x.png", 2, "picture 4 is outside the capture, which has 4");
}

TEST_F(BetweenPictures, AreMadeAgainByARecipe) {
  const Words source("-f 20 --transfer srgb --between 3 --renderer reference frames");
  make("expose --start 10ms --exposure 150ms" + source + "-o p.png");
  expect_says(expect_made_again("p.png"), "--between 3");
  make("video --out-fps 10" + source + "-o f-%d.png");
  expect_made_again("f-1.png");
  // A clip that is read forward and its capture.
  make("encode -f 20 --transfer srgb --between 3 frames all.tik");
  make("expose --start 10ms --exposure 150ms --renderer reference --no-recipe all.tik -o r.png");
  make("expose --start 10ms --exposure 150ms --no-recipe" + source + "-o s.png");
  EXPECT_TRUE(file("r.png") == file("s.png"));
}

TEST_F(BetweenPictures, AreRefusedWhereTheyCannotBe) {
  make("encode -f 20 --between 3 frames all.tik");
  make("encode -f 20 --between 3 --from 0f --to 2f frames a.tik");
  make("encode -f 20 --between 3 --from 2f frames b.tik");
  expect_refused(2, {{"encode -f 20 --between many frames x.tik", "write auto, off, or how many samples"},
                     {"encode -f 20 --between 64 frames x.tik", "1 … 63"},
                     {"retime -f 40 all.tik x.tik", "has samples made between its pictures"},
                     {"expose --between 3 --exposure 1s all.tik -o x.png", "--between describes a clip"}});
  expect_refused(3, {{"join a.tik b.tik -o x.tik", "none could be made where it meets another"}});
  // Nothing moves in one picture.
  const auto one = make("encode -f 20 --between auto frames/0.pgm one.tik");
  expect_says(one.err, "no sample was made between two pictures");
}

}  // namespace
}  // namespace nutik::test
