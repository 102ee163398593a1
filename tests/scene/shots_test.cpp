// Where a capture is cut, and what is no cut.
#include "scene/shots.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace nutik {
namespace {

constexpr Shape kShape{96, 48, 1};
constexpr std::uint64_t kSamples = 30;

// A scene of squares of 6 pixels, each of some light of its own.
int scene(int number, int x, int y) {
  auto bits = static_cast<std::uint32_t>(1000 * number + 16 * (y / 6) + x / 6) * 2'654'435'761u;
  bits = (bits ^ bits >> 15) * 2'246'822'519u;
  return 40 + static_cast<int>((bits ^ bits >> 13) >> 25);
}

std::vector<SampleRange> shots(const std::function<int(int x, int y, std::uint64_t sample)>& code) {
  CaptureFormat format;
  format.shape = kShape;
  std::vector<std::vector<std::byte>> rasters;
  for (std::uint64_t k = 0; k < kSamples; ++k) {
    std::vector<std::byte>& raster = rasters.emplace_back();
    for (int y = 0; y < static_cast<int>(kShape.height); ++y)
      for (int x = 0; x < static_cast<int>(kShape.width); ++x)
        raster.push_back(static_cast<std::byte>(code(x, y, k)));
  }
  MemoryCapture capture(format, Timeline::constant({100, 1}, Timeline::kFullShutter, kSamples), rasters, 16);
  return shots_of(capture);
}

std::vector<std::uint64_t> starts(const std::function<int(int x, int y, std::uint64_t sample)>& code) {
  std::vector<std::uint64_t> starts;
  for (const SampleRange& shot : shots(code)) starts.push_back(shot.first);
  return starts;
}

using Starts = std::vector<std::uint64_t>;

// In a still scene a square of 8 x 8 goes its way, 2 pixels at a sample.
int filmed(int x, int y, std::uint64_t sample) {
  const int left = 4 + 2 * static_cast<int>(sample);
  return x >= left && x < left + 8 && y >= 20 && y < 28 ? 240 : scene(1, x, y);
}

TEST(Shots, BeginWhereTheSceneIsAnother) {
  EXPECT_EQ(starts([](int x, int y, std::uint64_t) { return scene(1, x, y); }), Starts{0});
  EXPECT_EQ(starts([](int x, int y, std::uint64_t k) { return scene(k < 9 ? 1 : k < 21 ? 2 : 3, x, y); }),
            (Starts{0, 9, 21}));
}

TEST(Shots, DoNotBeginWithAFlashOrALampOrATurn) {
  EXPECT_EQ(starts([](int x, int y, std::uint64_t k) { return k == 9 ? 255 : scene(1, x, y); }), Starts{0});
  EXPECT_EQ(starts([](int x, int y, std::uint64_t k) { return scene(1, x, y) + (k < 9 ? 0 : 60); }), Starts{0});
  EXPECT_EQ(starts([](int x, int y, std::uint64_t k) { return scene(static_cast<int>(k), x, y); }), Starts{0});
}

// A chart that covers a fifth of the scene, in a single picture before or behind it.
TEST(Shots, OfASinglePictureAtAnEndReplaceASixteenthOfTheScene) {
  const auto with_chart_at = [](std::uint64_t at) {
    return [at](int x, int y, std::uint64_t k) { return k == at && x < 20 ? scene(5, x, y) : filmed(x, y, k); };
  };
  EXPECT_EQ(starts(with_chart_at(0)), (Starts{0, 1}));
  EXPECT_EQ(starts(with_chart_at(kSamples - 1)), (Starts{0, kSamples - 1}));
  EXPECT_EQ(starts(with_chart_at(12)), Starts{0}) << "the scene after it is the one before it";
}

TEST(Shots, AtAnEndAreNoLargeThingThatMovesNorACameraThatSetsItsExposure) {
  EXPECT_EQ(starts(filmed), Starts{0});
  // It covers a quarter of the picture and goes a sixth of it at a sample.
  const auto large = [](int x, int y, std::uint64_t k) {
    const int left = 16 * static_cast<int>(k % 6);
    return x >= left && x < left + 24 ? 240 : scene(1, x, y);
  };
  EXPECT_EQ(starts(large), Starts{0});
  for (const int percent : {70, 85, 95}) {
    const auto set = [&](int x, int y, std::uint64_t k) { return filmed(x, y, k) * (k == 0 ? percent : 100) / 100; };
    EXPECT_EQ(starts(set), Starts{0}) << percent;
  }
}

}  // namespace
}  // namespace nutik
