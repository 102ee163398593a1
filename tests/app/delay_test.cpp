// Time maps as a user meets them: --delay, and every command that knows it.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "support/app_test.hpp"

namespace nutik::test {
namespace {

// Eight pictures at 100 a second of linear light, picture k of code 10 k, 6 x 4 pixels.
class DelayCommand : public AppTest {
 protected:
  void SetUp() override {
    write_frames(8, [](int k) { return cv::Mat(4, 6, CV_8UC1, cv::Scalar::all(10 * k)); });
    make("-f 100 --transfer linear frames clip.tik");
    cv::Mat map(4, 6, CV_16UC1);
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 6; ++x)
        map.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(x == 0 ? 0 : x * 65'535 / 5);
    }
    cv::imwrite((scratch_ / "map.tif").string(), map);
  }

  // One picture's time from 0 s on, with these delays, and what stands behind.
  static Words exposing(const std::string& delay, const Words& behind) {
    return "--start 0s --exposure 10ms --out-transfer source --delay " + delay + behind;
  }
  static std::vector<int> codes(const cv::Mat& line) { return {line.begin<std::uint8_t>(), line.end<std::uint8_t>()}; }
  [[nodiscard]] std::vector<int> column(const std::string& name) const { return codes(picture(name).col(2)); }
  [[nodiscard]] std::vector<int> row(const std::string& name) const { return codes(picture(name).row(1)); }
};

TEST_F(DelayCommand, SweepsThroughTheCaptureInEveryArithmetic) {
  for (const char* precision : {"auto", "single", "compensated", "double", "fixed"}) {
    make(exposing("rows:60ms", {"--precision", precision, "clip.tik", "out.pgm"}));
    EXPECT_EQ(column("out.pgm"), (std::vector<int>{0, 20, 40, 60})) << precision;
  }
  make(exposing("rows:60ms", {"--renderer", "reference", "clip.tik", "out.pgm"}));
  EXPECT_EQ(column("out.pgm"), (std::vector<int>{0, 20, 40, 60}));
  make(exposing("columns:50ms..0s", {"clip.tik", "out.pgm"}));
  EXPECT_EQ(row("out.pgm"), (std::vector<int>{50, 40, 30, 20, 10, 0}));
  make(exposing("map.tif:20ms..70ms", {"clip.tik", "out.pgm"}));
  EXPECT_EQ(row("out.pgm"), (std::vector<int>{20, 30, 40, 50, 60, 70}));
}

TEST_F(DelayCommand, TakesMapsOfLight) {
  make("-f 100 map.tif map.tik");
  for (const std::string extension : {"tif", "exr", "pfm", "npy"}) {
    make("--start 0f --exposure 1f --depth float map.tik light." + extension);
    make(exposing("light." + extension + ":20ms..70ms", {"--overwrite", "clip.tik", "out.pgm"}));
    EXPECT_EQ(row("out.pgm"), (std::vector<int>{20, 30, 40, 50, 60, 70})) << extension;
  }
}

TEST_F(DelayCommand, ReadsAClipForward) {
  make(exposing("rows:60ms", {"-f", "100", "--transfer", "linear", "frames", "out.pgm"}));
  EXPECT_EQ(column("out.pgm"), (std::vector<int>{0, 20, 40, 60}));
}

TEST_F(DelayCommand, GoesWithMasksSoftOnesToo) {
  cv::Mat mask(4, 6, CV_8UC1, cv::Scalar::all(0));
  mask.colRange(3, 6) = 9;
  cv::imwrite((scratch_ / "mask.pgm").string(), mask);
  scratch_.write(
      "f.fn",
      "M0 [0:1], [9999999:1], [10000000:0]\nM9 [9999999:0], [10000000:1], [19999999:1], [20000000:0]\n");
  const Words words("-k f.fn -m mask.pgm --delay rows:30ms --out-transfer source");
  make(words + "clip.tik out.pgm");
  EXPECT_EQ(row("out.pgm"), (std::vector<int>{10, 10, 10, 20, 20, 20}));
  make(words + "--feather 2px clip.tik soft.pgm");
  make(words + "--feather 2px --renderer reference clip.tik reference.pgm");
  EXPECT_EQ(row("soft.pgm"), (std::vector<int>{10, 11, 13, 17, 19, 20}));
  EXPECT_EQ(row("soft.pgm"), row("reference.pgm"));
}

TEST_F(DelayCommand, IsMadeAgainFromItsRecipe) {
  for (const std::string delay : {"rows:60ms", "radial:-5ms..20ms", "map.tif:20ms..70ms"}) {
    make(exposing(delay, {"--ev", "1", "clip.tik", "out.png"}));
    expect_made_again("out.png");
  }
  cv::imwrite((scratch_ / "map.tif").string(), cv::Mat(4, 6, CV_16UC1, cv::Scalar::all(7)));
  expect_says(make("reproduce out.png", 3).err, "map.tif is not the map of delays that the picture was made from");
}

TEST_F(DelayCommand, GoesWithSeriesSweepsAndVideos) {
  make(exposing("rows:30ms", {"--every", "10ms", "--count", "3", "clip.tik", "s%d.pgm"}));
  EXPECT_EQ(column("s2.pgm"), (std::vector<int>{20, 30, 40, 50}));
  make("sweep" + exposing("rows:30ms", "--shift 0ms..20ms/10ms --each w%d.pgm clip.tik sheet.png"));
  EXPECT_EQ(column("w2.pgm"), (std::vector<int>{20, 30, 40, 50}));
  make(
      "video --delay rows:30ms --out-fps 100 --out-angle 360 --to 50ms --out-transfer source clip.tik "
      "v%d.pgm");
  EXPECT_EQ(column("v2.pgm"), (std::vector<int>{20, 30, 40, 50}));
}

TEST_F(DelayCommand, WeighsFunctionsByTheirWholeCourse) {
  scratch_.write("f.fn", "M0 [-20000000:0], [-19999999:2], [19999999:2], [20000000:0]\n");
  for (const std::string normalization : {"support", "integral"}) {
    make({"-k", "f.fn", "--delay", "rows:20ms..50ms", "--normalize", normalization, "--out-transfer",
          "source", "clip.tik", "out.pgm"});
    // The mean of four pictures, and twice that.
    const int factor = normalization == "support" ? 2 : 1;
    EXPECT_EQ(column("out.pgm"), (std::vector<int>{15 * factor, 25 * factor, 35 * factor, 45 * factor}))
        << normalization;
  }
}

TEST_F(DelayCommand, WarnsOfPixelsThatLeaveTheCapture) {
  expect_says(make(exposing("rows:-30ms..60ms", {"clip.tik", "out.pgm"})).err,
              "for 6 of 24 pixels the delay moves the whole function outside of the capture");
  EXPECT_EQ(make(exposing("rows:60ms", {"clip.tik", "out.pgm"})).err.find("warning"), std::string::npos);
}

TEST_F(DelayCommand, IsOfAnIntervalThatMayLieOutside) {
  const std::string delay = "--exposure 10ms --out-transfer source --delay rows:-60ms..-30ms ";
  make("--start 90ms " + delay + "clip.tik out.pgm");
  EXPECT_EQ(column("out.pgm"), (std::vector<int>{30, 40, 50, 60}));
  make("--start 90ms --every 10ms --count 2 " + delay + "clip.tik s%d.pgm");
  EXPECT_EQ(column("s1.pgm"), (std::vector<int>{40, 50, 60, 70}));
  const json all = answer("expose --overwrite --start 90ms --every 10ms " + delay + "clip.tik s%d.pgm");
  EXPECT_EQ(all["pictures"].size(), 2u);
  expect_refused(2, {{"--start 90ms --exposure 10ms --delay rows:-5ms clip.tik o.pgm",
                      "the interval from 90 ms on with all its delays lies outside the capture"},
                     {"--start=-20ms --exposure 10ms clip.tik o.pgm", "the interval from -20 ms on lies outside"}});
}

TEST_F(DelayCommand, IsTracedAndChecked) {
  const json trace = answer("trace" + exposing("rows:60ms", "--pixel 2,3 clip.tik"));
  EXPECT_NEAR(trace["light"][0].get<double>() * 255, 60, 1e-9);
  EXPECT_EQ(trace["nonzero_ns"], 10'000'000);
  make("validate" + exposing("rows:60ms", "clip.tik"));

  scratch_.write("f.fn", "M0 [0:0], [1:1], [9999999:1], [10000000:0]\n");
  const std::string checked = make("check -k f.fn --delay rows:60ms clip.tik").out;
  EXPECT_EQ(checked.find("the delay moves"), std::string::npos);
  expect_says(checked, "80 ms; figures are without the delay\n");
  expect_says(make("check -k f.fn --delay rows:90ms clip.tik").out,
              "for 6 of 24 pixels the delay moves the whole function outside");
}

TEST_F(DelayCommand, SaysWhatIsWrong) {
  expect_refused(
      2, {{exposing("rows", {"clip.tik", "o.pgm"}), "--delay rows is not known; did you mean rows:?"},
          {exposing("15ms", {"clip.tik", "o.pgm"}), "--delay '15ms' does not say where and by how much"},
          {exposing("rows:15", {"clip.tik", "o.pgm"}), "'15' is no time; write a number and a unit: 0.4s, 10ms, "
                                                       "250us, 1/100s or 0:01.5\n"},
          {exposing("rows:0s..x", {"clip.tik", "o.pgm"}), "--delay 'x' is no time"},
          {exposing("rows:3f", {"clip.tik", "o.pgm"}), "counts pictures, which are no length of time"}});
  expect_refused(exposing("gone.tif:1s", {"clip.tik", "o.pgm"}), 3, "gone.tif cannot be read: no such file");
  expect_refused(exposing("clip.tik:1s", {"clip.tik", "o.pgm"}), 3,
                 "clip.tik is a capture (.tik) already, not a picture");
  expect_refused(exposing("frames:1s", {"clip.tik", "o.pgm"}), 2, "frames is a sequence of 8");
  cv::imwrite((scratch_ / "small.png").string(), cv::Mat(3, 6, CV_8UC1, cv::Scalar::all(0)));
  expect_refused(exposing("small.png:1s", {"clip.tik", "o.pgm"}), 3,
                 "small.png is 6 x 3 pixels and the pictures are 6 x 4; a map of delays needs their size");
  cv::imwrite((scratch_ / "colour.png").string(), cv::Mat(4, 6, CV_8UC3, cv::Scalar(1, 2, 3)));
  expect_refused(exposing("colour.png:1s", {"clip.tik", "o.pgm"}), 3, "colour.png is a colour picture");
  expect_says(make("check --delay small.png:1s clip.tik", 3).out, "a map of delays needs their size");

  scratch_.write("six.pgm", "P5 6 4 255\n" + std::string(24, '\0'));
  scratch_.write("one.fn", "M0 [0:1], [10000000:1], [10000001:0]\n");
  expect_says(make("check -k one.fn -m six.pgm --delay small.png:1s", 3).out, "a map of delays needs their size");
  expect_says(make("check -k one.fn --delay rows:1s").out, "without a capture it is not known which delays leave it");
  expect_refused("trace --tag 0 -k f.fn -m mask.pgm --delay rows:1ms clip.tik", 3, "f.fn");
  expect_refused(exposing("map.tif:1s", {"clip.tik", "map.tif"}), 2, "map.tif");
  EXPECT_FALSE(exists("o.pgm"));
}

}  // namespace
}  // namespace nutik::test
