// Light below 0 in pictures of codes: what each --negative makes of it, and what the program counts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "support/app_test.hpp"

namespace nutik::test {
namespace {

// sRGB as IEC 61966-2-1 writes it.
double light_of(int code) {
  const double v = code / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}
double fraction_of(double light) {
  return light <= 0.0031308 ? light * 12.92 : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

// Two pictures of 8 pixels; the function takes the second from the first.
class Negative : public AppTest, public testing::WithParamInterface<const char*> {
 protected:
  void SetUp() override {
    write_frames(2, [](int k) { return cv::Mat(2, 4, CV_8UC1, const_cast<std::uint8_t*>(kCodes[k])); });
    scratch_.write("difference.fn", "M0 [0:1], [39999999:1], [40000000:-1], [79999999:-1], [80000000:0]\n");
    make("-f 25 frames clip.tik");
  }

  ProgramResult expose(const std::string& output, const Words& more, int status = 0) const {
    return make(more + "--gain 4 -k difference.fn clip.tik -o" + output + "--renderer" + GetParam(), status);
  }
  [[nodiscard]] std::vector<int> codes(const std::string& name) const {
    const cv::Mat read = picture(name);
    EXPECT_EQ(read.total(), 8u);
    return {read.begin<std::uint8_t>(), read.end<std::uint8_t>()};
  }
  // (v0 - v1) / 2 times 4, but for two steps of 1 ns.
  [[nodiscard]] static double light(std::size_t pixel) {
    return 2 * (light_of(kCodes[0][pixel]) - light_of(kCodes[1][pixel]));
  }

  static constexpr std::uint8_t kCodes[2][8] = {{0, 255, 128, 50, 10, 200, 0, 255}, {255, 0, 128, 60, 10, 100, 0, 255}};
};

TEST_P(Negative, SaturatesToBlackByItself) {
  const ProgramResult result = expose("a.png", {});
  expose("b.png", "--no-recipe --negative saturate");
  EXPECT_EQ(codes("a.png"), codes("b.png"));
  for (std::size_t i = 0; i < 8; ++i) {
    const double clipped = std::clamp(light(i), 0.0, 1.0);
    EXPECT_EQ(codes("a.png")[i], std::floor(255 * fraction_of(clipped) + 0.5)) << i;
  }
  // -2 and -0.03 below, 2 above; exactly 0 and 0.9 are held.
  expect_says(result.out, ", 2 pixels saturated below 0 and 1 above 1,");
}

TEST_P(Negative, OffsetPutsZeroIntoTheMiddle) {
  const ProgramResult result = expose("a.png", "--negative offset");
  for (std::size_t i = 0; i < 8; ++i) {
    const double magnitude = std::floor(127 * fraction_of(std::min(std::fabs(light(i)), 1.0)) + 0.5);
    EXPECT_EQ(codes("a.png")[i], light(i) < 0 ? 128 - magnitude : 128 + magnitude) << i;
  }
  EXPECT_EQ(codes("a.png")[2], 128);
  expect_says(result.out, ", 1 pixel saturated below 0 and 1 above 1,");
}

TEST_P(Negative, AbsShowsMagnitudes) {
  const ProgramResult result = expose("a.png", "--negative abs --json");
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(codes("a.png")[i], std::floor(255 * fraction_of(std::min(std::fabs(light(i)), 1.0)) + 0.5))
        << i;
  }
  const nlohmann::json json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["saturated_below_pixels"], 0);
  EXPECT_EQ(json["saturated_above_pixels"], 2);  // 2, and -2, whose magnitude is
}

TEST_P(Negative, CountsNothingWhereLightFits) {
  // White that stays white is no saturation, nor is black that stays black.
  expect_says(make({"--renderer", GetParam(), "--start", "0s", "--exposure", "1f", "clip.tik", "a.png"}).out,
              ", no pixel below 0 or above 1,");
  const ProgramResult light = expose("a.pfm", {});
  EXPECT_EQ(light.out.find("saturated"), std::string::npos) << light.out;
}

TEST_P(Negative, IsRefusedWhereLightIsKept) {
  expect_says(expose("a.pfm", "--negative abs", 2).err, "a.pfm holds floating point, which keeps it");
}

TEST_P(Negative, SumsOverSeriesVideosBatchesAndSheets) {
  const auto expect = [&](const Words& words, const char* part) {
    expect_says(make(words + "--renderer" + GetParam()).out, part);
  };
  expect(
      {"--gain", "4", "-k", "difference.fn", "--every", "1s", "--count", "1", "clip.tik", "-o", "s-%d.png"},
      ", 2 pixels saturated below 0 and 1 above 1,");
  expect({"video", "--gain", "4", "-k", "difference.fn", "--out-fps", "1", "--speed", "1", "clip.tik",
          "v-%d.png"},
         ", 2 pixels saturated below 0 and 1 above 1,");
  scratch_.write("list.txt",
                 "--gain 4 -k difference.fn a.png\n--gain 4 --negative abs -k difference.fn b.png\n");
  expect({"batch", "list.txt", "clip.tik"}, ", 2 pixels saturated below 0 and 3 above 1,");
  expect({"sweep", "--negative", "offset", "--gain", "4", "-k", "difference.fn", "--scale-gain", "0.5..1/0.5",
          "clip.tik", "sheet.png"},
         "saturated below 0 and");
}

TEST_P(Negative, IsInTheRecipe) {
  expose("a.png", "--negative offset");
  expect_says(run("reproduce a.png").out, " --negative offset ");
}

INSTANTIATE_TEST_SUITE_P(Renderers, Negative, testing::Values("opencl", "reference"),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace nutik::test
