// Where a capture is cut, and what is no cut.
#include "scene/shots.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

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
  std::vector<std::vector<std::byte>> rasters;
  for (std::uint64_t k = 0; k < kSamples; ++k) {
    std::vector<std::byte>& raster = rasters.emplace_back();
    for (int y = 0; y < static_cast<int>(kShape.height); ++y)
      for (int x = 0; x < static_cast<int>(kShape.width); ++x)
        raster.push_back(static_cast<std::byte>(code(x, y, k)));
  }
  MemoryCapture capture({.shape = kShape}, Timeline::constant({100, 1}, Timeline::kFullShutter, kSamples), rasters, 16);
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

using Mixture = std::function<int(int x, int y, double way)>;

// Up to sample 8 one scene, from sample 20 on another, and what `mixture` makes of both between.
std::vector<SampleRange> shots_with(const Mixture& mixture) {
  return shots([&](int x, int y, std::uint64_t k) {
    const double way = std::clamp((static_cast<double>(k) - 8) / 12, 0.0, 1.0);
    return way == 0 ? filmed(x, y, k) : mixture(x, y, way);
  });
}

int mixed(double a, double b, double share) { return static_cast<int>(std::lround(a + (b - a) * share)); }

// Up to a dissolve of samples 9 to 19, and behind it.
void expect_two(const std::vector<SampleRange>& found) {
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].first, 0u);
  EXPECT_TRUE(found[0].last >= 6 && found[0].last <= 9) << found[0].last << ": sample 9 is mixed";
  EXPECT_TRUE(found[1].first >= 20 && found[1].first <= 23) << found[1].first << ": sample 19 is mixed";
  EXPECT_EQ(found[1].last, kSamples);
}

TEST(Shots, LieBesideADissolveOrAFade) {
  const auto still = [](int x, int y, double way) { return mixed(scene(1, x, y), scene(2, x, y), way); };
  const auto slow = [&](int x, int y, double way) { return still(x, y, way * way * (3 - 2 * way)); };
  const auto faded = [](double to) {
    return [to](int x, int y, double way) {
      return mixed(scene(way < 0.5 ? 1 : 2, x, y), to, 1 - std::abs(2 * way - 1));
    };
  };
  for (const Mixture& mixture : {Mixture(still), Mixture(slow), Mixture(faded(0)), Mixture(faded(255))}) {
    expect_two(shots_with(mixture));
  }
  EXPECT_EQ(starts_of(std::vector<SampleRange>{{0, 9}, {20, 30}}, 5), "5, 25 (behind a dissolve or fade from 14 on)");
}

// In both scenes something black goes its way that is a seventh of the picture.
TEST(Shots, LieBesideADissolveOfScenesInWhichSomethingMoves) {
  const auto with_black = [](int number, int x, int y, std::uint64_t k) {
    const int left = 10 + static_cast<int>(k);
    return x >= left && x < left + 20 && y >= 10 && y < 44 ? 0 : scene(number, x, y);
  };
  expect_two(shots([&](int x, int y, std::uint64_t k) {
    const double way = std::clamp((static_cast<double>(k) - 8) / 12, 0.0, 1.0);
    return mixed(with_black(1, x, y, k), with_black(2, 95 - x, y, k), way);
  }));
}

TEST(Shots, AreNotDividedByWhatChangesSlowlyAndIsNoDissolve) {
  const std::pair<const char*, Mixture> others[] = {
      {"exposure", [](int x, int y, double way) { return scene(1, x, y) + mixed(0, 80, way); }},
      {"lamp", [](int x, int y, double way) { return mixed(scene(1, x, y), scene(1, x, y) * x / 48.0, way); }},
      {"dip to black", [](int x, int y, double way) { return mixed(0, scene(1, x, y), std::abs(2 * way - 1)); }},
      {"pan", [](int x, int y, double way) { return scene(1, x + mixed(0, 96, way), y); }},
      {"zoom", [](int x, int y, double way) { return scene(1, mixed(x, x / 5.0, way), mixed(y, y / 5.0, way)); }},
      {"wipe", [](int x, int y, double way) { return scene(x < 96 * way ? 2 : 1, x, y); }},
      {"tone", [](int x, int y, double way) { return std::clamp(scene(1, x, y) + mixed(0, 250, way) - 40, 0, 255); }},
  };
  for (const auto& [name, mixture] : others) EXPECT_EQ(shots_with(mixture).size(), 1u) << name;
  const auto passes = [](int x, int y, std::uint64_t k) {  // larger than the picture
    const int left = 8 * static_cast<int>(k) - 140;
    return x >= left && x < left + 120 ? scene(2, x - left, y) : scene(1, x, y);
  };
  EXPECT_EQ(starts(passes), Starts{0});
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
