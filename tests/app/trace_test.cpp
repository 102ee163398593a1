// nutik-cl trace as a user meets it: figures worked out by hand, tables, pictures, the reference's value.
#include <gtest/gtest.h>

#include <array>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "support/app_test.hpp"

namespace nutik::test {
namespace {

// Four pictures of 10 ms each. The left half has light 0.2, 0.4, 0.4, 0.8, the right one 0.6 at all times.
class TraceCommand : public AppTest {
 protected:
  void SetUp() override {
    write_frames(4, [](int k) {
      cv::Mat picture(6, 8, CV_8UC1, cv::Scalar::all(std::array{51, 102, 102, 204}[static_cast<std::size_t>(k)]));
      picture.colRange(4, 8) = 153;
      return picture;
    });
    make("-f 100 --transfer linear frames clip.tik");
    cv::Mat mask(6, 8, CV_8UC1, cv::Scalar::all(0));
    mask.colRange(2, 6) = 9;  // half of it over each half of the picture
    cv::imwrite((scratch_ / "mask.pgm").string(), mask);
    scratch_.write("f.fn", "M0 [0:1], [10000000:0]\nM9 [0:1], [40000000:1]\n");
  }
};

TEST_F(TraceCommand, ByHand) {
  const ProgramResult result = make("trace --pixel 3,2 --start 5ms --exposure 20ms clip.tik");
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(result.out,
            " from ns     to ns  gain  light      adds  sum\n"
            "       0   5000000  0     0.2        0     0\n"
            " 5000000  10000000  1     0.2        0.05  0.05\n"
            "10000000  25000000  1     0.4        0.3   0.35\n"
            "25000000  40000000  0     (2 steps)  0     0.35\n"
            "clip.tik, pixel 3,2, the exposure: light 0.35, code 160; 5 steps, D 20 ms, ∫g 20 ms\n");
}

TEST_F(TraceCommand, ATableOfTheIntegrals) {
  make("trace --pixel 3,2 --start 5ms --exposure 20ms clip.tik trace.csv");
  std::istringstream table(file("trace.csv"));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(
      line,
      "begin_ns,end_ns,begin_gain,end_gain,grey_begin_light,grey_end_light,grey_integral_ns,grey_sum_ns");
  const std::vector<std::vector<double>> wanted{{0, 5e6, 0, 0, 0.2, 0.2, 0, 0},
                                                {5e6, 10e6, 1, 1, 0.2, 0.2, 1e6, 1e6},
                                                {10e6, 25e6, 1, 1, 0.4, 0.4, 6e6, 7e6},
                                                {25e6, 30e6, 0, 0, 0.4, 0.4, 0, 7e6},
                                                {30e6, 40e6, 0, 0, 0.8, 0.8, 0, 7e6}};
  for (const auto& row : wanted) {
    ASSERT_TRUE(std::getline(table, line));
    std::istringstream cells(line);
    for (const double number : row) {
      std::string cell;
      ASSERT_TRUE(std::getline(cells, cell, ','));
      EXPECT_DOUBLE_EQ(std::stod(cell), number) << line;
    }
  }
  EXPECT_FALSE(std::getline(table, line));
}

TEST_F(TraceCommand, ARegionsMeanAsJson) {
  const json trace = answer("trace --tag 9 -m mask.pgm -k f.fn clip.tik");
  expect_says(run("trace --tag 9 --feather 2px -m mask.pgm -k f.fn clip.tik").out, " with a share of mask value 9");
  EXPECT_EQ(trace.at("pixels"), 24);
  EXPECT_EQ(trace.at("mask_value"), 9);
  // The mean of 0.2, 0.4, 0.4, 0.8 and 0.6: 0.4, 0.5, 0.5, 0.7.
  ASSERT_EQ(trace.at("steps").size(), 3u);
  EXPECT_DOUBLE_EQ(trace.at("steps")[0].at("values")[0].at("begin_light"), 0.4);
  EXPECT_DOUBLE_EQ(trace.at("steps")[1].at("values")[0].at("begin_light"), 0.5);
  EXPECT_DOUBLE_EQ(trace.at("steps")[2].at("values")[0].at("end_light"), 0.7);
  EXPECT_DOUBLE_EQ(trace.at("light")[0], 0.525);
  EXPECT_FALSE(trace.contains("x"));
}

TEST_F(TraceCommand, ItsLightIsTheReferencesPixel) {
  make("--renderer reference -m mask.pgm -k f.fn clip.tik reference.pfm");
  const cv::Mat reference = picture("reference.pfm");
  ASSERT_EQ(reference.type(), CV_32FC1);
  for (const auto& [x, y] : {std::pair{0, 0}, {3, 2}, {5, 5}, {7, 1}}) {
    const std::string pixel = std::to_string(x) + "," + std::to_string(y);
    const json trace = answer("trace -m mask.pgm -k f.fn clip.tik --pixel " + pixel);
    EXPECT_EQ(trace.at("x"), x);
    EXPECT_EQ(static_cast<float>(trace.at("light")[0].get<double>()), reference.at<float>(y, x));
  }
}

TEST_F(TraceCommand, AClipIsTracedAsItsCapture) {
  expect_says(make("trace -f 100 --transfer linear frames --pixel 3,2 --start 5ms --exposure 20ms").out,
              "frames, pixel 3,2, the exposure: light 0.35,");
}

TEST_F(TraceCommand, LongRunsAreFoldedUnlessAllIsWanted) {
  std::filesystem::create_directory(scratch_ / "long");
  for (int k = 0; k < 50; ++k) {
    cv::imwrite((scratch_ / ("long/" + std::to_string(100 + k) + ".pgm")).string(),
                cv::Mat(2, 2, CV_8UC1, cv::Scalar::all(5 * k)));
  }
  make("-f 100 long long.tik");
  const Words words("trace --pixel 0,0 --start 0s --exposure 400ms long.tik");
  const std::string folded = make(words).out;
  expect_says(folded, "(36 steps)");  // of 40, without two at each end
  expect_says(folded, "(10 steps)");  // where the gain is 0
  EXPECT_EQ(std::count(folded.begin(), folded.end(), '\n'), 1 + 5 + 1 + 1);
  const std::string whole = make(words + "-v").out;
  EXPECT_EQ(std::count(whole.begin(), whole.end(), '\n'), 1 + 50 + 1);
}

TEST_F(TraceCommand, APicture) {
  expect_says(make("trace --tag 9 -m mask.pgm -k f.fn clip.tik trace.png").out,
              "trace.png: clip.tik, mean of 24 pixels with mask value 9, M9: light 0.525,");
  const cv::Mat picture = cv::imread((scratch_ / "trace.png").string(), cv::IMREAD_COLOR);
  ASSERT_FALSE(picture.empty());
  // Gains are above 0 everywhere: blue areas, no orange ones.
  cv::Mat blue, orange;
  cv::inRange(picture, cv::Scalar(233, 202, 158), cv::Scalar(233, 202, 158), blue);
  cv::inRange(picture, cv::Scalar(134, 192, 253), cv::Scalar(134, 192, 253), orange);
  EXPECT_GT(cv::countNonZero(blue), 100'000);
  EXPECT_EQ(cv::countNonZero(orange), 0);
}

TEST_F(TraceCommand, RefusesWhatMakesNoSense) {
  expect_refused(
      2, {{"trace -k f.fn -m mask.pgm clip.tik", "Either --pixel X,Y or --tag VALUE"},
          {"trace --pixel 1,1 --tag 0 -k f.fn -m mask.pgm clip.tik", "Either --pixel X,Y or --tag VALUE"},
          {"trace --tag 0 --exposure 1ms clip.tik", "--tag is a value of a mask"},
          {"trace --tag 5 -k f.fn -m mask.pgm clip.tik", "no pixel of the mask has the value 5"},
          {"trace --pixel 8,0 --exposure 1ms clip.tik", "there is no pixel 8,0: the picture has 0,0 … 7,5"},
          {"trace --pixel 3 --exposure 1ms clip.tik", "--pixel 320,180"},
          {"trace --pixel 3,x --exposure 1ms clip.tik", "pixel row 'x' is no whole number"},
          {"trace --pixel 0,0 clip.tik", "an exposure needs"},
          {"trace --pixel 0,0", "an input is missing"},
          {"trace --pixel 0,0 --exposure 1ms clip.tik x.txt",
           "traces are written as a table, .csv, or as a picture"},
          {"trace --pixel 0,0 --exposure 1ms clip.tik x.pfm", "x.pfm"},
          {"trace --pixel 0,0 -k f.fn -m mask.pgm clip.tik -o mask.pgm", "is also an input"}});
}

}  // namespace
}  // namespace nutik::test
