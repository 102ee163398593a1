// What a picture may be off by: told to scripts and people, as a map of pixels, and refused with --strict.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "support/app_test.hpp"
#include "support/still_clip.hpp"

namespace nutik {
namespace {

using nlohmann::json;

// 24 stills of 16 x 16 pixels at 100 a second, and two functions: the left half is plain, the right cancels.
class UncertaintyOf : public test::AppTest {
 protected:
  void SetUp() override {
    test::write_still_clip(scratch_.folder(), 16, 24);
    make("-f 100 --tolerance 2 frames clip.tik");
    scratch_.write("f.fn",
                   "M0 [0:1], [99999999:1], [100000000:0]\n"
                   "M9 [0:1e30], [99999999:1e30], [100000000:-1e30], [199999999:-1e30], [200000000:0]\n");
    std::string mask = "P2 16 16 255\n";
    for (int pixel = 0; pixel < 256; ++pixel) mask += pixel % 16 < 8 ? "0 " : "9 ";
    scratch_.write("mask.pgm", mask);
    scratch_.write("cancels.fn", "M0 [0:1e6], [99999999:1e6], [100000000:-1e6], [199999999:-1e6], [200000000:0]\n");
  }

  static json term_of(const json& told, const std::string& name) {
    for (const json& term : told["terms"]) {
      if (term["term"] == name) return term;
    }
    return {};
  }
};

TEST_F(UncertaintyOf, APictureIsToldTermByTerm) {
  const json told = answer("--start 0s --exposure 0.1s --json clip.tik a.png")["uncertainty"];
  EXPECT_EQ(told["scale"], 1.0);
  const json arithmetic = term_of(told, "arithmetic"), rounding = term_of(told, "rounding"),
             held = term_of(told, "held_samples"), times = term_of(told, "times");
  for (const json& term : {arithmetic, rounding, held, times}) EXPECT_EQ(term["is"], "bound") << told;
  EXPECT_LT(arithmetic["light"], 1e-6);
  EXPECT_LT(arithmetic["codes"], 0.01);
  EXPECT_EQ(rounding["codes"], 0.5);
  // sRGB by hand: its steepest code is the last, 2.275 of light for all of them.
  EXPECT_NEAR(rounding["light"].get<double>(), 2.275 * 0.5 / 255, 1e-5);
  EXPECT_NEAR(held["light"].get<double>(), 2.275 * 2 / 255, 2e-4);
  EXPECT_NEAR(times["light"].get<double>(), 11 / 1e8, 1e-12) << "gains of 1, 10 samples of 0.1 s";
  double light = 0, shares = 0;
  for (const json& term : told["terms"]) {
    light += term["light"].get<double>();
    shares += term["share_of_bounds"].get<double>();
  }
  EXPECT_NEAR(told["bounds"]["light"].get<double>(), light, 1e-12);
  EXPECT_NEAR(shares, 1.0, 1e-12);
  EXPECT_GT(held["share_of_bounds"], 0.5) << "the tolerance is the largest";
  const json offset =
      answer("--start 0s --exposure 0.1s --negative offset --json clip.tik b.png")["uncertainty"];
  EXPECT_NEAR(term_of(offset, "rounding")["light"].get<double>(), 2.275 / 255, 1e-4) << "half of the codes";
}

// Floats, and pictures that were made smaller, are rounded to the capture's codes first.
TEST_F(UncertaintyOf, CodesThatWereRoundedHaveHalfOfOne) {
  make("--start 0s --exposure 1f clip.tik light.npy");
  for (const std::string source : {"--white 1.0 light.npy", "--scale 1/2 frames"}) {
    make("encode -f 100 --overwrite " + source + " r.tik");
    const json told = answer("--start 0s --exposure 1f --depth double --json r.tik a.npy --overwrite")["uncertainty"];
    const double codes = source.find("scale") == source.npos ? 65535.0 : 255 / 2.275;
    EXPECT_NEAR(term_of(told, "rounded_codes")["light"].get<double>() * codes, 0.5, 0.01) << told;
  }
  const json own = answer("--start 0s --exposure 1f --json clip.tik b.npy")["uncertainty"];
  EXPECT_TRUE(term_of(own, "rounded_codes").is_null());
}

// By the function that is stated.
TEST_F(UncertaintyOf, WhatIsHeldFollowsTheStatedFunction) {
  const json told = answer("--start 0s --exposure 0.1s --transfer linear --json clip.tik a.png")["uncertainty"];
  EXPECT_NEAR(term_of(told, "held_samples")["light"].get<double>(), 2.0 / 255, 1e-9);
}

// Light that is combined is not averaged: a ramp that falls from 2 leaves it up to twice as large.
TEST_F(UncertaintyOf, CombinedLightIsAsLargeAsTheLargestGain) {
  scratch_.write("ramp.fn", "M0 [0:0], [200000000:2]\n");
  const json told = answer("--combine lighten -k ramp.fn --json clip.tik a.png")["uncertainty"];
  EXPECT_EQ(told["scale"], 2.0) << told;
  EXPECT_TRUE(term_of(told, "times").is_null());
  expect_refused("--combine lighten --start 0s --exposure 0.1s --bounds m.tif clip.tik b.png", 2, "adds nothing up");
  expect_refused("--start 0s --exposure 0.1s --bounds tif:- clip.tik b.png", 2, "standard output has one picture");
}

TEST_F(UncertaintyOf, FloatsAreInStepsAndTheReferenceHasTheLeast) {
  const json floats = answer("--start 0s --exposure 0.1s --json clip.tik a.pfm")["uncertainty"];
  EXPECT_LE(term_of(floats, "arithmetic")["float_steps"], 0.5);
  EXPECT_EQ(term_of(floats, "rounding")["float_steps"], 0.5);
  const json reference =
      answer("--start 0s --exposure 0.1s --renderer reference --json clip.tik b.pfm")["uncertainty"];
  EXPECT_EQ(term_of(reference, "arithmetic")["light"], 30 * 0x1p-53);
}

// Two pictures, of which the worse one counts.
TEST_F(UncertaintyOf, ABatchAndAVideoAreToldAsWell) {
  scratch_.write("list", "--start 0s --exposure 0.1s a.png\n--start 0s --exposure 0.1s --gain 3 b.png\n");
  EXPECT_EQ(answer("batch --json list clip.tik")["uncertainty"]["scale"], 3.0);
  const json film = answer("video --json --out-fps 25 --out-angle 360 clip.tik film%d.png")["uncertainty"];
  EXPECT_EQ(film["scale"], 1.0) << film;
  EXPECT_GT(film["bounds"]["light"], 0.0);
}

TEST_F(UncertaintyOf, PeopleAreToldInLines) {
  const std::string text = make("-v --start 0s --exposure 0.1s clip.tik a.png").out;
  expect_says(text, {"uncertainty, S = 1:\n", "\n  arithmetic    bound      light within ", ", single\n",
                     "\n  held samples  bound", "\n  all bounds    bound"});
}

// It follows from the rest: a picture that is there is not made again for it.
TEST_F(UncertaintyOf, ARecipeKeepsWhatTheArithmeticMayBeOffBy) {
  const std::string one = "--start 0s --exposure 0.1s clip.tik a.pgm";
  make(one);
  expect_says(test::read_file(scratch_ / "a.pgm"), R"("precision":"single","error_bound":"light within )");
  expect_says(make("--skip-existing " + one).out, "there already");
  expect_says(make("again a.pgm").out, " --precision single clip.tik");
}

// A function of gain 1e30 spoils its own pixels alone.
TEST_F(UncertaintyOf, AMapHasTheBoundOfEachPixel) {
  make("-m mask.pgm -k f.fn --bounds map.pfm clip.tik a.png");
  const std::vector<float> map = test::read_pfm(scratch_ / "map.pfm");
  ASSERT_EQ(map.size(), 256u);
  for (std::size_t pixel = 0; pixel < map.size(); ++pixel) {
    if (pixel % 16 < 8) {
      EXPECT_LT(map[pixel], 0.01f) << "in codes";
    } else {
      EXPECT_GE(map[pixel], 255.0f);
    }
  }
  make("-m mask.pgm -k f.fn --bounds map.tif --renderer reference clip.tik a.pfm --overwrite");
  const cv::Mat light = cv::imread((scratch_ / "map.tif").string(), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(light.type(), CV_32FC1);
  EXPECT_NEAR(light.at<float>(0, 0), 30 * 0x1p-53, 1e-20);
  EXPECT_GT(light.at<float>(0, 15), 1e14);
}

TEST_F(UncertaintyOf, AMapHasANameOfItsOwnThatHoldsFloats) {
  const std::string one = "--start 0s --exposure 1f clip.tik a.tif --bounds ";
  expect_refused(one + "a.tif", 2, "a.tif");
  expect_refused(one + "map.jpg", 2, "map.jpg");
  expect_refused(one + "clip.tik", 2, "clip.tik");
  expect_refused("--start 0s --exposure 1f --every 5f clip.tik s%d.png --bounds map.tif", 2,
                 "--bounds goes with one picture, not with --every");
  scratch_.write("list", "--start 0s --exposure 1f a.png --bounds map.tif\n");
  expect_says(make("batch list clip.tik", 1).err, "list:1: --bounds goes with one picture");
}

// The same bounds that are otherwise a warning.
TEST_F(UncertaintyOf, StrictlyTooLargeIsAnErrorWithAStatusOfItsOwn) {
  const std::string single = "-k cancels.fn --precision single clip.tik a.png";
  expect_says(make(single).err, "single is not sure to be right to 0.5 of a code here");
  expect_refused("--strict --overwrite " + single, 7, "single is not sure to be right to 0.5 of a code here");
  make("--strict --start 0s --exposure 0.1s --precision single clip.tik b.png");
  // None is right enough for these.
  expect_refused("--strict -m mask.pgm -k f.fn clip.tik c.png", 7, "no arithmetic of ");
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "c.png"));
  // A line fails alone.
  scratch_.write("list", "-m mask.pgm -k f.fn c.png\n--start 0s --exposure 1f d.png\n");
  expect_says(make("batch --strict list clip.tik", 7).err, "list:1: no arithmetic of ");
  EXPECT_TRUE(std::filesystem::exists(scratch_ / "d.png"));
  expect_refused("video --strict --out-fps 25 -m mask.pgm -k f.fn clip.tik f%d.png", 7, "no arithmetic of ");
}

}  // namespace
}  // namespace nutik
