// Soft masks as a user meets them: --feather, layers, and every command that knows them.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "support/app_test.hpp"

namespace nutik::test {
namespace {

// Two pictures of linear light, codes 51 and 204. M0 exposes the first, M9 the second; M9 is the right half.
class SoftMaskCommand : public AppTest {
 protected:
  void SetUp() override {
    write_frames(2, [](int k) { return cv::Mat(1, 6, CV_8UC1, cv::Scalar::all(k == 0 ? 51 : 204)); });
    make("-f 100 --transfer linear frames clip.tik");
    cv::Mat mask(1, 6, CV_8UC1, cv::Scalar::all(0));
    mask.colRange(3, 6) = 9;
    cv::imwrite((scratch_ / "mask.pgm").string(), mask);
    scratch_.write("f.fn",
                   "M0 [0:1], [9999999:1], [10000000:0]\nM9 [9999999:0], [10000000:1], [20000000:1]\n");
  }

  // An exposure's words: feathered by 2 pixels, unless others are wanted, and what stands behind them.
  static Words exposing(const Words& behind, const std::string& mask = "mask.pgm", const std::string& feather = "2px") {
    return "-k f.fn --out-transfer source -m " + mask + (feather.empty() ? "" : " --feather " + feather) + behind;
  }
  [[nodiscard]] std::vector<int> codes(const std::string& name) const {
    const cv::Mat read = picture(name);
    return {read.begin<std::uint8_t>(), read.end<std::uint8_t>()};
  }
  void write_layer(const std::string& name, const std::vector<int>& codes) const {
    cv::Mat layer(1, static_cast<int>(codes.size()), CV_8UC1);
    for (std::size_t x = 0; x < codes.size(); ++x)
      layer.at<std::uint8_t>(0, static_cast<int>(x)) = static_cast<std::uint8_t>(codes[x]);
    cv::imwrite((scratch_ / name).string(), layer);
  }
};

// 51 + 153 α, α being 0, 1/8, 1/3, 2/3, 7/8, 1.
TEST_F(SoftMaskCommand, FeathersEdgesInLight) {
  const std::vector<int> wanted{51, 70, 102, 153, 185, 204};
  for (const char* precision : {"auto", "single", "compensated", "double", "fixed"}) {
    make(exposing({"--precision", precision, "clip.tik", "out.pgm"}));
    EXPECT_EQ(codes("out.pgm"), wanted) << precision;
  }
  make(exposing({"--renderer", "reference", "clip.tik", "out.pgm"}));
  EXPECT_EQ(codes("out.pgm"), wanted);
  make(exposing({"clip.tik", "hard.pgm"}, "mask.pgm", ""));
  EXPECT_EQ(codes("hard.pgm"), (std::vector<int>{51, 51, 51, 204, 204, 204}));
}

TEST_F(SoftMaskCommand, ReadsLayers) {
  write_layer("half-9.png", {0, 51, 102, 255, 255, 0});
  make(exposing({"clip.tik", "out.pgm"}, "half-%d.png", ""));
  EXPECT_EQ(codes("out.pgm"), (std::vector<int>{51, 82, 112, 204, 204, 51}));  // 51 + 153 · 0.2, · 0.4
  // Another layer, and a mask value without a function.
  write_layer("half-0.png", {255, 204, 153, 0, 0, 255});
  make(exposing({"clip.tik", "again.pgm"}, "half-%d.png", ""));
  EXPECT_EQ(codes("again.pgm"), codes("out.pgm"));
  write_layer("half-7.png", {0, 0, 0, 0, 0, 0});
  make(exposing({"clip.tik", "again.pgm"}, "half-%d.png", ""));
  write_layer("half-7.png", {0, 0, 0, 255, 9, 0});
  expect_refused(
      exposing({"clip.tik", "no.pgm"}, "half-%d.png", ""), 3,
      "the layers of the mask come to more than all of 2 pixels: to 2 at 3,0 (half-7.png 1, half-9.png 1)");
  write_layer("half-9.png", {0, 51, 102, 0, 0, 0});
  expect_refused(exposing({"clip.tik", "no.pgm"}, "half-%d.png", ""), 3, "7 (2 pixels)");
}

TEST_F(SoftMaskCommand, MakesLayersThatGiveTheSamePicture) {
  const json made =
      answer("mask --size 6x1 --tag 9 --rectangle 3,0,3,1 --feather 2px -o soft-%d.png --preview preview.png");
  EXPECT_EQ(made["mixed_pixel_count"], 4);
  EXPECT_EQ(made["tags"][1]["layer"], "soft-9.png");
  EXPECT_EQ(picture("soft-9.png").at<std::uint16_t>(0, 2), 21'845);
  make(exposing({"clip.tik", "feathered.pgm"}));
  make(exposing({"clip.tik", "layered.pgm"}, "soft-%d.png", ""));
  EXPECT_EQ(codes("layered.pgm"), codes("feathered.pgm"));

  expect_refused("mask --overwrite --size 6x1 --tag 7 --rectangle 3,0,3,1 --feather 2px -o soft-%d.png", 5,
                 "soft-9.png is there, and M9 has no pixel in this mask");
  expect_refused(2, {{"mask --size 6x1 --fill --feather 2px -o soft.png", "as in soft-%d.png"},
                     {"mask --size 6x1 --fill --feather 2px -o new-%d.png --preview new-255.png", "another output"},
                     {"mask --size 6x1 --fill --feather 2px -o new-%d.png --preview new-7.png", "another output"}});
}

TEST_F(SoftMaskCommand, CarriesItsRecipe) {
  for (const std::string& mask : {std::string("mask.pgm"), std::string("soft-%d.png")}) {
    write_layer("soft-9.png", {0, 51, 102, 255, 255, 0});
    make(exposing({"clip.tik", "first.png"}, mask, mask == "mask.pgm" ? "1px,M9=2.5px" : ""));
    expect_says(expect_made_again("first.png"), mask);
    // A layer that was changed since is another mask.
    if (mask == "mask.pgm") continue;
    write_layer("soft-9.png", {0, 51, 103, 255, 255, 0});
    make("reproduce first.png", 3);
  }
}

TEST_F(SoftMaskCommand, TracesAPixelThroughAllItsFunctions) {
  expect_says(make("trace --pixel 2,0 -k f.fn -m mask.pgm --feather 2px --out-transfer source clip.tik").out,
              "clip.tik, pixel 2,0: light 0.4, code 102, of 2 functions\n"
              "  M0 (66.67 %): light 0.2;");
  const json traced = answer("trace --pixel 2,0 -k f.fn -m mask.pgm --feather 2px clip.tik");
  EXPECT_NEAR(traced["light"][0], 0.4, 1e-7);  // gains change over a nanosecond
  EXPECT_EQ(traced["functions"][1]["mask_value"], 9);
  EXPECT_NEAR(traced["functions"][1]["share"], 1.0 / 3, 1e-12);
  make("trace --pixel 2,0 -k f.fn -m mask.pgm --feather 2px clip.tik trace.csv");
  EXPECT_TRUE(file("trace.csv").starts_with("mask_value,share,begin_ns,"));
  make("trace --pixel 2,0 -k f.fn -m mask.pgm --feather 2px clip.tik one.png");
  make("trace --pixel 0,0 -k f.fn -m mask.pgm --feather 2px clip.tik other.png");
  EXPECT_EQ(picture("one.png").rows, 2 * picture("other.png").rows);
}

TEST_F(SoftMaskCommand, IsKnownToOtherCommands) {
  const Words soft("-k f.fn -m mask.pgm --feather 2px");
  make("check" + soft + "clip.tik");
  make("validate --runs 1" + soft + "clip.tik");
  make("sweep --scale-gain 1..2/1 --each each-%d.pgm --out-transfer source" + soft + "clip.tik sheet.png");
  EXPECT_EQ(codes("each-0.pgm"), (std::vector<int>{51, 70, 102, 153, 185, 204}));
  make("video --out-fps 50 --out-transfer source" + soft + "clip.tik filmed-%d.pgm");
  EXPECT_EQ(codes("filmed-0.pgm"), codes("each-0.pgm"));
  scratch_.write("list.txt", "-k f.fn -m mask.pgm --feather 2px --out-transfer source listed.pgm\n");
  make("batch list.txt clip.tik");
  EXPECT_EQ(codes("listed.pgm"), codes("each-0.pgm"));
  write_layer("soft-9.png", {0, 51, 102, 255, 255, 0});
  EXPECT_EQ(make("check -k f.fn -m soft-%d.png clip.tik").err, "");
}

TEST_F(SoftMaskCommand, SaysWhatIsWrong) {
  expect_refused(
      2, {{exposing({"clip.tik", "no.pgm"}, "mask.pgm", "2"), "the feather '2' is no width of an edge"},
          {exposing({"clip.tik", "no.pgm"}, "mask.pgm", "M4=2px"), "no pixel of the mask has the value 4"},
          {"--start 0s --exposure 1f --feather 2px clip.tik no.pgm", "add -m mask.pgm"}});
  expect_refused(
      exposing({"clip.tik", "no.pgm"}, "none-%d.png", ""), 3,
      "none-%d.png cannot be read: there is no layer of any mask value, none-0.png to none-255.png");
  write_layer("soft-9.png", {0, 51, 102, 255, 255, 0});
  expect_refused(exposing({"clip.tik", "no.pgm"}, "soft-%d.png", "2px"), 2, "made of layers");
  write_layer("soft-9.png", {0, 51});
  expect_refused(exposing({"clip.tik", "no.pgm"}, "soft-%d.png", ""), 3, "soft-9.png: the mask is 2 x 1");
}

}  // namespace
}  // namespace nutik::test
