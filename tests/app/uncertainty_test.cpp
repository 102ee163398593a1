// What a picture may be off by: told to scripts and people, as a map of pixels, and refused with --strict.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <utility>

#include "support/app_test.hpp"
#include "support/still_clip.hpp"
#include "support/tik_files.hpp"

namespace nutik::test {
namespace {

// 24 stills of 16 x 16 pixels at 100 a second, and two functions: the left half is plain, the right cancels.
class UncertaintyOf : public AppTest {
 protected:
  void SetUp() override {
    write_still_clip(scratch_.folder(), 16, 24);
    make("-f 100 --tolerance 2 frames clip.tik");
    scratch_.write("f.fn",
                   "M0 [0:1], [99999999:1], [100000000:0]\n"
                   "M9 [0:1e30], [99999999:1e30], [100000000:-1e30], [199999999:-1e30], [200000000:0]\n");
    std::string mask = "P2 16 16 255\n";
    for (int pixel = 0; pixel < 256; ++pixel) mask += pixel % 16 < 8 ? "0 " : "9 ";
    scratch_.write("mask.pgm", mask);
    scratch_.write("cancels.fn", "M0 [0:1e6], [99999999:1e6], [100000000:-1e6], [199999999:-1e6], [200000000:0]\n");
  }

  // [layers][pixels] of a file of NumPy's.
  std::vector<std::vector<float>> read_layers(const std::string& name, std::size_t count) {
    const std::string bytes = file(name);
    std::vector<std::vector<float>> layers(count, std::vector<float>(256));
    const std::size_t values = bytes.size() - count * 256 * sizeof(float);
    expect_says(bytes.substr(0, values), "(" + std::to_string(count) + ", 16, 16)");
    for (std::size_t layer = 0; layer < count; ++layer)
      std::memcpy(layers[layer].data(), bytes.data() + values + layer * 256 * sizeof(float), 256 * sizeof(float));
    return layers;
  }

  // A grey picture's, from the top, of light or of codes.
  std::vector<float> values_of(const std::string& name) {
    const std::string bytes = file(name);
    std::vector<float> values(256);
    if (name.ends_with(".npy")) {
      std::memcpy(values.data(), bytes.data() + bytes.size() - 256 * sizeof(float), 256 * sizeof(float));
    } else {
      std::ranges::transform(bytes.substr(bytes.size() - 256), values.begin(),
                             [](char code) { return static_cast<float>(static_cast<unsigned char>(code)); });
    }
    return values;
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
  // No gain is negative: a mean of sRGB's codes that are 2 off is 2 off, a little more behind the straight toe.
  EXPECT_GE(held["codes"], 2.0);
  EXPECT_LT(held["codes"], 2.8);
  EXPECT_LT(told["bounds"]["codes"], 3.3);
  EXPECT_GT(told["bounds"]["codes"], 2.5);
  scratch_.write("signs.fn", "M0 [0:1], [99999999:1], [100000000:-1], [199999999:-1], [200000000:0]\n");
  const json signs = answer("-k signs.fn --negative offset --json clip.tik c.png")["uncertainty"];
  EXPECT_GT(term_of(signs, "held_samples")["codes"], 30.0) << "a difference may be black";
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
  const json said = answer("--combine lighten -k ramp.fn --json clip.tik a.png"), told = said["uncertainty"];
  EXPECT_FALSE(said["functions"][0].contains("still_gain"));  // the integral's
  EXPECT_EQ(told["scale"], 2.0) << told;
  EXPECT_TRUE(term_of(told, "times").is_null());
  make("--combine darken --start 0s --exposure 0.1s --bounds m.npy clip.tik b.png");
  const auto layers = read_layers("m.npy", 4);  // all bounds, arithmetic, rounding, held samples
  EXPECT_LT(std::ranges::max(layers[1]), 1e-9f) << "nothing is added up";
  EXPECT_NEAR(std::ranges::max(layers[3]), 2.0f, 0.8f);
  expect_refused("--start 0s --exposure 0.1s --bounds tif:- clip.tik b.png", 2, "standard output has one picture");
  expect_refused("--start 0s --exposure 0.1s --bounds m.npy clip.tik b.jpg", 2, "b.jpg loses more than a map counts");
  expect_refused("--start 0s --exposure 0.1s --bounds m.npy clip.tik jpg:-", 2, "jpg:- loses more than a map counts");
  expect_refused("--start 0s --exposure 0.1s --bounds m.npy --depth half clip.tik b.exr", 2, "--depth half loses more");
  expect_refused("video --bounds m%d.npy clip.tik v.mp4", 2, "h264 loses more than a map counts; write ffv1");
  expect_refused("--start 0s --exposure 4f --every 4f --bounds m.npy clip.tik s%d.png", 2,
                 "a series needs a number in its maps' name, as in m-%03d.npy");
  expect_says(make("--start 0s --exposure 0.1s --gain 1e300 --depth double --bounds far.npy clip.tik far.tif").err,
              "the map has 256 of 256 bounds beyond floating point of 32 bits");
  make("-f 100 --pixel-aspect 2:1 frames wide.tik");
  expect_says(make("--start 0s --exposure 0.1s --bounds w.npy wide.tik w.png").err,
              "maps of bounds have the capture's 16 x 16 pixels");
}

TEST_F(UncertaintyOf, FloatsAreInStepsAndTheReferenceHasTheLeast) {
  const json floats = answer("--start 0s --exposure 0.1s --json clip.tik a.pfm")["uncertainty"];
  EXPECT_LE(term_of(floats, "arithmetic")["float_steps"], 0.5);
  EXPECT_EQ(term_of(floats, "rounding")["float_steps"], 0.5);
  for (const std::string kind : {"pfm", "exr", "tif --depth float"})
    expect_says(make("--start 0s --exposure 0.1s --gain 1e200 clip.tik infinite." + kind).err,
                "values are beyond floating point of 32 bits");
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
  // Gains that grow: each frame's own, of which the last is the largest.
  scratch_.write("one.fn", "M0 [0:1], [39999999:1], [40000000:0]\n");
  scratch_.write("four.fn", "M0 [0:4], [39999999:4], [40000000:0]\n");
  const json grown =
      answer("video --json --out-fps 25 --key 0s one.fn --key 200ms four.fn clip.tik grown%d.png");
  const json frames = grown["pictures"];
  ASSERT_EQ(frames.size(), grown["frames"]);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    EXPECT_EQ(frames[k]["frame"], k);
    const json own = frames[k]["uncertainty"];
    EXPECT_LE(own["bounds"]["light"], grown["uncertainty"]["bounds"]["light"]);
    if (k > 0 && k <= 5) {
      EXPECT_GT(own["scale"], frames[k - 1]["uncertainty"]["scale"]);
    }
  }
  EXPECT_EQ(frames.back()["uncertainty"], grown["uncertainty"]);
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
  expect_says(file("a.pgm"), R"("precision":"single","error_bound":"light within )");
  expect_says(make("--skip-existing " + one).out, "there already");
  expect_says(make("reproduce a.pgm").out, " --precision single clip.tik");
}

// A map has no recipe: its picture's names it, in that picture's folder.
TEST_F(UncertaintyOf, ReproducingMakesTheMapToo) {
  const std::string one = "--start 0s --exposure 0.1s clip.tik ";
  make(one + "a.png --bounds maps.npy");
  const std::string picture = file("a.png"), map = file("maps.npy");
  const std::string command = make("reproduce a.png").out;
  expect_says(command, " --precision single --bounds maps.npy clip.tik -o a.png");
  std::filesystem::remove(scratch_ / "a.png");
  std::filesystem::remove(scratch_ / "maps.npy");
  make(command.substr(command.find(" expose ") + 1, command.size() - command.find(" expose ") - 2));
  EXPECT_EQ(file("a.png"), picture) << "to the last byte";
  EXPECT_EQ(file("maps.npy"), map);
  expect_says(make("--skip-existing " + one + "a.png").out, "there already");
  make("--start 0s --exposure 4f --every 4f --count 2 clip.tik s%d.png --bounds smap%d.npy");
  expect_says(make("reproduce s1.png").out, " --bounds smap1.npy clip.tik");
  make("video --out-fps 25 clip.tik f%d.png --bounds fmap%d.npy");
  expect_says(make("reproduce f3.png").out, " --bounds fmap3.npy clip.tik");
  scratch_.write("list", "--start 0s --exposure 4f b.png --bounds bmap.npy\n");
  make("batch list clip.tik");
  expect_says(make("reproduce b.png").out, " --bounds bmap.npy clip.tik");
  make(one + "c.pgm --bounds cmap.npy");
  std::string foreign = file("c.pgm");
  foreign.replace(foreign.find("cmap.npy"), 8, "../x.npy");
  scratch_.write("c.pgm", foreign);
  expect_says(make("reproduce c.pgm", 3).err, "names have no folders");
}

// A recipe's checksum tells its map from another file of that name, which is not replaced; earlier programs kept none.
TEST_F(UncertaintyOf, AMapIsReplacedOnlyIfItIsWhatTheRecipeKnows) {
  const std::string one = "--start 0s --exposure 0.1s clip.tik a.pgm --bounds map.npy";
  make(one);
  make(one + " --gain 2");
  const std::string map = file("map.npy");
  scratch_.write("map.npy", map + " of mine");
  for (const std::string words : {"", " --skip-existing --gain 3"})
    expect_refused(one + words, 2, "map.npy is there already and is not replaced");
  EXPECT_EQ(file("map.npy"), map + " of mine");
  scratch_.write("map.npy", map);
  std::string picture = file("a.pgm");
  const auto at = picture.find(R"({"name":"map.npy")");
  ASSERT_NE(at, std::string::npos);
  scratch_.write("a.pgm", picture.replace(at, picture.find('}', at) + 1 - at, R"("map.npy")"));
  expect_says(make("reproduce a.pgm").out, " --bounds map.npy clip.tik");
  expect_refused(one, 2, "a.pgm is there already and is not replaced: its recipe does not know it");
  make(one + " --overwrite");
  make(one);
}

// A map is as good as its picture: it is left, missed, and made again with it.
TEST_F(UncertaintyOf, SkippingLeavesAPictureWithItsMap) {
  scratch_.write("list", "--start 0s --exposure 4f b0.png --bounds b0.npy\n"
                         "--start 4f --exposure 4f b1.png --bounds b1.npy\n");
  const std::pair<std::string, std::string> cases[] = {
      {"--start 0s --exposure 4f --every 4f --count 2 clip.tik s%d.png --bounds s%d.npy", "s"},
      {"video --out-fps 25 --frames 0-1 clip.tik f%d.png --bounds f%d.npy", "f"},
      {"batch list clip.tik", "b"}};
  for (const auto& [command, name] : cases) {
    make(command);
    const std::string skipping = (command[0] == '-' ? "expose " : "") + command + " --skip-existing";
    const std::string map = file(name + "1.npy");
    expect_says(make(skipping).out, "there already");
    std::filesystem::remove(scratch_ / (name + "1.npy"));
    expect_says(make(skipping).out, "1 ");
    EXPECT_EQ(file(name + "1.npy"), map) << command;
    if (name == "b") continue;
    // A map of that name in another folder is none of its pictures'.
    std::filesystem::create_directory(scratch_ / "other");
    std::filesystem::copy(scratch_ / (name + "0.npy"), scratch_ / "other" / (name + "0.npy"));
    std::string elsewhere = skipping;
    elsewhere.insert(elsewhere.find("--bounds ") + 9, "other/");
    expect_says(make(elsewhere, 2).err, "other/" + name + "0.npy is there already and is not replaced");
    // If a picture is made otherwise, so is its map; one that no picture there names is not replaced.
    make(skipping + " --gain 2");
    EXPECT_NE(file(name + "1.npy"), map) << command;
    std::filesystem::remove(scratch_ / (name + "1.png"));
    expect_says(make(skipping, 2).err, name + "1.npy is there already and is not replaced");
  }
  const std::string again = make("reproduce b1.png").out;
  make(again.substr(again.find(" expose ") + 1, again.size() - again.find(" expose ") - 2));
}

// Codes that the program makes of a clip's are off by what it rounds; what has no bound is named.
TEST_F(UncertaintyOf, RoundingsOfTheProgramAreTold) {
  for (const auto& [how, codes] : {std::pair("--deflicker", 0.5), std::pair("--scale 1/2 --deflicker", 2.0)}) {
    make(std::string("encode -f 100 --transfer linear --overwrite ") + how + " frames r.tik");
    const std::string picture = "--start 0s --exposure 1f --overwrite r.tik a.npy";
    const json told = answer("--json --depth double " + picture)["uncertainty"];
    EXPECT_NEAR(term_of(told, "rounded_codes")["light"].get<double>() * 255, codes, 1e-3) << how << told;
    EXPECT_EQ(term_of(told, "deflicker")["is"], "no_bound") << how << told;
    expect_says(make("-v " + picture).out, "\n  deflicker     no bound");
  }
  // Nor is how codes of earlier versions' captures were made.
  write_saying(tik::Reader(scratch_ / "clip.tik"), scratch_ / "old.tik",
               [](tik::Header& header) { header.roundings.add(0.0, 1.0, kUnknown); });
  const std::string picture = "--start 0s --exposure 1f --overwrite --bounds map.exr old.tik a.png";
  EXPECT_EQ(term_of(answer("--json " + picture)["uncertainty"], "unknown")["is"], "no_bound");
  expect_says(make("-v " + picture).out, "\n  unknown       no bound   how codes were made: an earlier version");
  expect_says(file("map.exr"), "no pixel is further off by all bounds together; without a bound: unknown");
}

// A function of gain 1e30 spoils its own pixels alone.
TEST_F(UncertaintyOf, AMapHasTheBoundOfEachPixel) {
  make("-m mask.pgm -k f.fn --bounds map.npy clip.tik a.png");
  const auto layers = read_layers("map.npy", 5);  // all bounds, arithmetic, rounding, held samples, times
  make("-m mask.pgm -k f.fn --bounds map.pfm clip.tik a.png --overwrite");
  std::vector<float> alone = read_pfm(scratch_ / "map.pfm");  // from its bottom row
  std::ranges::reverse(alone);
  for (auto row = alone.begin(); row != alone.end(); row += 16) std::reverse(row, row + 16);
  EXPECT_EQ(alone, layers[0]) << "one picture: all bounds";
  for (std::size_t pixel = 0; pixel < 256; ++pixel) {
    if (pixel % 16 < 8) {
      EXPECT_LT(layers[1][pixel], 0.01f) << "in codes";
      EXPECT_NEAR(layers[3][pixel], 2.0f, 0.2f) << "the tolerance, with the codes that were rounded to this one";
      EXPECT_LT(layers[0][pixel], 3.0f);
    } else {
      EXPECT_GE(layers[1][pixel], 255.0f);
      EXPECT_EQ(layers[0][pixel], std::nextafter(255.0f, 256.0f));
    }
    EXPECT_EQ(layers[2][pixel], std::nextafter(0.5f, 1.0f));
  }
  make("-m mask.pgm -k f.fn --bounds map.tif --renderer reference clip.tik a.pfm --overwrite");
  std::vector<cv::Mat> light;
  ASSERT_TRUE(cv::imreadmulti((scratch_ / "map.tif").string(), light, cv::IMREAD_UNCHANGED));
  ASSERT_EQ(light.size(), 5u);
  ASSERT_EQ(light[1].type(), CV_32FC1);
  EXPECT_NEAR(light[1].at<float>(0, 0), 30 * 0x1p-53, 1e-20);
  EXPECT_GT(light[1].at<float>(0, 15), 1e14);
  for (int x = 0; x < 16; ++x) {
    float sum = 0;
    for (int term = 1; term <= 4; ++term) sum += light[static_cast<std::size_t>(term)].at<float>(3, x);
    EXPECT_FLOAT_EQ(light[0].at<float>(3, x), sum) << "light adds up";
  }
}

// No pixel of a capture with a tolerance is further from the lossless one's than its map says.
TEST_F(UncertaintyOf, AMapHoldsAgainstTheLosslessCapture) {
  make("-f 100 frames lossless.tik");
  for (const std::string how : {"--start 0s --exposure 0.1s ", "-k cancels.fn --gain 1e-6 "}) {
    for (const std::string kind : {"pgm", "npy"}) {
      const std::string negative = kind == "pgm" && how[0] == '-' && how[1] == 'k' ? "--negative offset " : "";
      make(how + negative + "lossless.tik exact." + kind + " --overwrite --renderer reference");
      make(how + negative + "clip.tik held." + kind + " --overwrite --bounds map.npy");
      const auto map = read_layers("map.npy", 5);
      const std::vector<float> exact = values_of("exact." + kind), held = values_of("held." + kind);
      double most = 0.0;
      for (std::size_t pixel = 0; pixel < 256; ++pixel) {
        const double rounded = kind == "pgm" ? 0.5 : 0.0;  // of the other one
        EXPECT_LE(std::fabs(exact[pixel] - held[pixel]), map[0][pixel] + rounded) << how << ", pixel " << pixel;
        most = std::max(most, std::fabs(exact[pixel] - held[pixel]) / double{map[0][pixel]});
      }
      EXPECT_GT(most, 0.01) << "it says nothing";
    }
  }
}

// OpenEXR has a channel for each term, and says what each is.
TEST_F(UncertaintyOf, AnExrHasLayersThatAreReadAgainAsOnePicture) {
  make("-m mask.pgm -k f.fn --bounds map.exr clip.tik a.png");
  const std::string bytes = file("map.exr");
  expect_says(bytes, {"arithmetic.Y", "rounding.Y", "held_samples.Y", "times.Y",
                      "held_samples: a bound, in codes, of which 255 is white: no pixel is further off"});
  make("encode -f 1 --white 300 map.exr again.tik");
  expect_says(make("reproduce map.exr", 3).err, "recipe");
  // A channel that nothing describes may be anything, and is named.
  std::string foreign = bytes;
  const std::string described{"times\0string", 12};
  ASSERT_NE(foreign.find(described), std::string::npos);
  foreign.replace(foreign.find(described), 5, "other");
  scratch_.write("foreign.exr", foreign);
  expect_says(make("encode -f 1 --white 300 foreign.exr foreign.tik").err, "the file's channel times.Y is left out");
}

TEST_F(UncertaintyOf, AMapHasANameOfItsOwnThatHoldsFloats) {
  const std::string one = "--start 0s --exposure 1f clip.tik a.tif --bounds ";
  expect_refused(one + "a.tif", 2, "a.tif");
  expect_refused(one + "map.jpg", 2, "map.jpg");
  expect_refused(one + "clip.tik", 2, "clip.tik");
  expect_refused("--start 0s --exposure 1f --every 5f clip.tik s%d.png --bounds map.tif", 2,
                 "a series needs a number in its maps' name");
  expect_refused("--start 0s --exposure 1f --every 5f clip.tik s%d.tif --bounds s%d.tif", 2, "s0.tif");
  expect_refused("video --out-fps 25 clip.tik f%d.png --bounds map.tif", 2,
                 "a video needs a number in its maps' name");
  scratch_.write("list",
                 "--start 0s --exposure 1f a.png --bounds map.tif\n"
                 "--start 1f --exposure 1f b.png --bounds map.tif\n");
  expect_says(make("batch list clip.tik", 1).err, "list:2: map.tif is written by line 1 already");
}

// A map for each picture, whatever makes it: the same one.
TEST_F(UncertaintyOf, SeriesBatchesAndVideosHaveAMapOfEachPicture) {
  make("--start 4f --exposure 4f clip.tik one.png --bounds one.npy");
  const json series =
      answer("--start 0s --exposure 4f --every 4f --count 2 --json clip.tik s%d.png --bounds smap%d.npy");
  EXPECT_EQ(series["pictures"][1]["bounds_map"], "smap1.npy") << series;
  scratch_.write("list", "--start 0s --exposure 4f b0.png\n--start 4f --exposure 4f b1.png --bounds bmap1.npy\n");
  make("batch list clip.tik");
  const json film = answer("video --json --out-fps 25 --out-angle 360 clip.tik film.mkv --bounds fmap%d.npy");
  EXPECT_EQ(film["bounds_maps"], "fmap%d.npy") << film;
  const std::string one = file("one.npy");
  for (const std::string map : {"smap1.npy", "bmap1.npy", "fmap1.npy"}) EXPECT_EQ(file(map), one) << map;
  EXPECT_FALSE(exists("fmap6.npy"));
}

// The same bounds that are otherwise a warning.
TEST_F(UncertaintyOf, StrictlyTooLargeIsAnErrorWithAStatusOfItsOwn) {
  const std::string single = "-k cancels.fn --precision single clip.tik a.png";
  expect_says(make(single).err, "single is not sure to be right to 0.5 of a code here");
  expect_refused("--strict --overwrite " + single, 7, "single is not sure to be right to 0.5 of a code here");
  make("--strict --start 0s --exposure 0.1s --precision single clip.tik b.png");
  // Floats are judged by half a step, as auto chooses for them.
  const std::string floats = "--start 0s --exposure 0.1s --precision single clip.tik a.pfm";
  EXPECT_EQ(make(floats).err.find("not sure"), std::string::npos) << "it was asked for";
  expect_refused("--strict --overwrite " + floats, 7, "single is not sure to be right to 0.5 of a float's step here");
  make("--strict --start 0s --exposure 0.1s clip.tik b.pfm");
  make("--strict --start 0s --exposure 0.1s --precision single --depth half clip.tik b.exr");
  // The reference, too, which says nothing otherwise; it makes what is combined.
  for (const std::string how :
       {"--renderer reference -m mask.pgm -k f.fn", "--combine lighten --start 0s --exposure 0.1s --gain 1e30"}) {
    make(how + " clip.tik r.png --overwrite");
    expect_refused("--strict " + how + " clip.tik s.png", 7, "the reference is not sure to be right to 0.5 of a code");
  }
  make("--strict --renderer reference --start 0s --exposure 0.1s clip.tik s.png");
  make("--strict --combine lighten --start 0s --exposure 0.1s clip.tik t.png");
  // None is right enough for these.
  expect_refused("--strict -m mask.pgm -k f.fn clip.tik c.png", 7, "no arithmetic of ");
  EXPECT_FALSE(exists("c.png"));
  // A line fails alone.
  scratch_.write("list", "-m mask.pgm -k f.fn c.png\n--start 0s --exposure 1f d.png\n");
  expect_says(make("batch --strict list clip.tik", 7).err, "list:1: no arithmetic of ");
  EXPECT_TRUE(exists("d.png"));
  expect_refused("video --strict --out-fps 25 -m mask.pgm -k f.fn clip.tik f%d.png", 7, "no arithmetic of ");
}

}  // namespace
}  // namespace nutik::test
