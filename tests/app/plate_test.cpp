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

TEST_F(Plates, SayWhatTheyCannotBeMadeOf) {
  make("-f 100 frames/00.pgm one.tik");
  expect_refused("background one.tik", 3, "one.tik: a single sample does not tell what moves");
  make("background clip.tik --uncertain clip-background.png", 2);  // both of one name
  expect_refused("background clip.tik --uncertain unsure.jpg", 2, "masks are written as .pgm or .png");
}

}  // namespace
}  // namespace nutik::test
