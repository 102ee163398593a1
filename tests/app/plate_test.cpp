// Plates as a user makes them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "support/moving_square_test.hpp"

namespace nutik::test {
namespace {

class Plates : public MovingSquareTest {};

TEST_F(Plates, HoldWhatEachPixelHoldsMostOften) {
  const auto json = answer("background clip.tik --by 0 --uncertain unsure.pgm");
  EXPECT_EQ(json["picture"], "clip-background.png");
  const cv::Mat plate = picture("clip-background.png"), unsure = picture("unsure.pgm");
  const std::size_t count = scene_.pictures.size();
  std::size_t uncertain = 0;
  for (std::size_t i = 0; i < scene_.pictures[0].size(); ++i) {
    std::array<std::size_t, 256> held{};
    for (const auto& shown : scene_.pictures) ++held[shown[i]];
    const std::size_t longest = *std::ranges::max_element(held);
    const int x = static_cast<int>(i) % plate.cols, y = static_cast<int>(i) / plate.cols;
    // What is uncertain is told together with what lies around.
    if (2 * longest >= count) {
      EXPECT_EQ(held[plate.at<std::uint8_t>(y, x)], longest) << x << ", " << y;
    } else {
      EXPECT_GT(held[plate.at<std::uint8_t>(y, x)], 0u) << x << ", " << y;
    }
    EXPECT_EQ(unsure.at<std::uint8_t>(y, x), 2 * longest < count ? 255 : 0) << x << ", " << y;
    uncertain += 2 * longest < count ? 1u : 0u;
  }
  EXPECT_EQ(json["uncertain_pixels"], uncertain);
}

TEST_F(Plates, AreTheSameOfAClipAPackedCaptureAndWithLittleMemory) {
  make("background clip.tik -o a.pfm");
  make("background -f 100 frames -o b.pfm");
  make("encode -f 100 --codec none frames -o plain.tik");
  make("background plain.tik -o c.pfm");
  EXPECT_EQ(file("a.pfm"), file("b.pfm"));
  EXPECT_EQ(file("a.pfm"), file("c.pfm"));
  expect_refused(2, {{"background --by 255 clip.tik -o d.pfm",
                      "no codes of clip.tik differ by more than 255, for white is 255"},
                     {"background --memory 1kB clip.tik -o d.pfm", "uncertain places"}});
}

// Its written pictures hold light in other codes than a linear capture of 12 bits: masks by them are as by the plate.
TEST_F(Plates, AreComparedWithTheCaptureInAnyWrittenCodes) {
  std::filesystem::create_directory(scratch_ / "deep");
  for (int k = 0; k < 12; ++k) {
    cv::Mat still(48, 64, CV_16UC3);
    for (int y = 0; y < still.rows; ++y) still.row(y) = cv::Scalar(100 + 40 * y, 300 + 20 * y, 2000);
    still(cv::Rect(4 + 4 * k, 20, 4, 4)) = cv::Scalar(4000, 3900, 100);
    cv::imwrite((scratch_ / "deep" / format("{:02}.png", k)).string(), still);
  }
  make("-f 100 --white 4095 deep deep.tik");
  make("-f 100 --white 4095 --transfer hlg --primaries bt2020 deep hlg.tik");
  for (const std::string capture : {"deep", "hlg"}) {
    make("mask --subject 5f " + capture + ".tik " + capture + ".pgm");
    int number = 0;
    for (const std::string output :
         {"a.png", "a.png --depth 8", "a.tif", "a.exr", "a.npy", "a.png --out-transfer source"}) {
      const std::string name = format("{}{}{}", capture, number++, output);
      make("background " + capture + ".tik " + name);
      const std::string picture = name.substr(0, name.find(' '));
      const auto json = answer("mask --difference " + picture + " 5f " + capture + ".tik " + picture + ".pgm");
      EXPECT_EQ(file(picture + ".pgm"), file(capture + ".pgm")) << output;
      EXPECT_EQ(json["notes"].size(), 0u) << json["notes"];
    }
  }
  make("background deep.tik a.ppm");
  expect_says(answer("mask --difference a.ppm 5f deep.tik a.pgm")["notes"].dump(),
              "a.ppm does not say what its codes stand for: they are taken for linear, as what is beside it");
  make("mask --difference deep0a.png deep1a.png -o b.pgm");
  EXPECT_EQ(cv::countNonZero(picture("b.pgm")), 0);
  make("-f 100 --white 4095 --primaries p3 deep p3.tik");
  make("background p3.tik p3.exr");
  expect_refused("mask --difference p3.exr 5f deep.tik c.pgm", 3,
                 "p3.exr holds linear in p3, the capture linear in bt709, and nothing tells how the one was made of "
                 "the other; write it in the capture's own codes: --out-transfer source");
}

TEST_F(Plates, SayWhatTheyCannotBeMadeOf) {
  make("-f 100 frames/00.pgm one.tik");
  expect_refused("background one.tik", 3, "one.tik: a single sample does not tell what moves");
  make("background clip.tik --uncertain clip-background.png", 2);  // both of one name
  expect_refused("background clip.tik --uncertain unsure.jpg", 2, "masks are written as .pgm or .png");
}

}  // namespace
}  // namespace nutik::test
