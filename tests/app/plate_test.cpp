// Plates as a user makes them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "support/moving_square_test.hpp"

namespace nutik {
namespace {

class Plates : public test::MovingSquareTest {
 protected:
  [[nodiscard]] cv::Mat picture(std::string_view name) const {
    return cv::imread((scratch_ / name).string(), cv::IMREAD_UNCHANGED);
  }
};

TEST_F(Plates, HoldWhatEachPixelHoldsMostOften) {
  const auto result = run({"plate", "clip.tik", "--by", "0", "--json", "--uncertain", "unsure.pgm"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["picture"], "clip-plate.png");
  const cv::Mat plate = picture("clip-plate.png"), unsure = picture("unsure.pgm");
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
  ASSERT_EQ(run({"plate", "clip.tik", "-o", "a.pfm"}).status, 0);
  ASSERT_EQ(run({"plate", "-f", "100", "frames", "-o", "b.pfm"}).status, 0);
  ASSERT_EQ(run({"encode", "-f", "100", "--codec", "none", "frames", "-o", "plain.tik"}).status, 0);
  ASSERT_EQ(run({"plate", "plain.tik", "-o", "c.pfm"}).status, 0);
  EXPECT_EQ(test::read_file(scratch_ / "a.pfm"), test::read_file(scratch_ / "b.pfm"));
  EXPECT_EQ(test::read_file(scratch_ / "a.pfm"), test::read_file(scratch_ / "c.pfm"));
  expect_refused({"plate", "--by", "255", "clip.tik", "-o", "d.pfm"}, 2,
                 "no codes of clip.tik differ by more than 255, for white is 255");
  const auto refused = run({"plate", "--memory", "1kB", "clip.tik", "-o", "d.pfm"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("uncertain places"), std::string::npos) << refused.err;
}

TEST_F(Plates, SayWhatTheyCannotBeMadeOf) {
  ASSERT_EQ(run({"-f", "100", "frames/00.pgm", "one.tik"}).status, 0) << "a single picture";
  const auto single = run({"plate", "one.tik"});
  EXPECT_EQ(single.status, 3);
  EXPECT_NE(single.err.find("one.tik: a single sample does not tell what moves"), std::string::npos)
      << single.err;
  EXPECT_EQ(run({"plate", "clip.tik", "--uncertain", "clip-plate.png"}).status, 2) << "both of one name";
  const auto lossy = run({"plate", "clip.tik", "--uncertain", "unsure.jpg"});
  EXPECT_EQ(lossy.status, 2);
  EXPECT_NE(lossy.err.find("masks are written as .pgm or .png"), std::string::npos) << lossy.err;
}

}  // namespace
}  // namespace nutik
