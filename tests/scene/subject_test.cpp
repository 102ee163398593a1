// What is found to move before an empty scene, where one knows what does.
#include "scene/subject.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "imev/capture_source.hpp"

namespace nutik {
namespace {

constexpr Shape kSceneShape{160, 120, 1};
constexpr std::uint64_t kSceneSamples = 40;
constexpr int kBallWidth = 24, kBallHeight = 16, kBallTop = 60;

int left_at(std::uint64_t sample) { return 10 + 3 * static_cast<int>(sample); }

// Grey but where `differs(x, y, sample)`.
std::vector<SubjectTrack> tracked(const std::function<bool(int, int, std::uint64_t)>& differs,
                                  const Rectangle& region = Rectangle::whole(kSceneShape)) {
  const CaptureFormat format{.shape = kSceneShape};
  std::vector<std::vector<std::byte>> rasters;
  for (std::uint64_t k = 0; k < kSceneSamples; ++k) {
    std::vector<std::byte>& raster = rasters.emplace_back(format.sample_bytes(), std::byte{100});
    for (int y = 0; y < static_cast<int>(kSceneShape.height); ++y) {
      for (int x = 0; x < static_cast<int>(kSceneShape.width); ++x) {
        if (differs(x, y, k))
          raster[static_cast<std::size_t>(y) * kSceneShape.width + static_cast<std::size_t>(x)] = std::byte{200};
      }
    }
  }
  MemoryCapture capture(format, Timeline::constant({100, 1}, Timeline::kFullShutter, kSceneSamples), rasters, 16);
  Picture plate(kSceneShape, ValueType::code8, 255);
  std::fill(plate.bytes.begin(), plate.bytes.end(), std::byte{100});
  return track_subjects(capture, plate, 8, {region});
}

TEST(Subject, IsFollowedWhereItGoes) {
  const auto tracks = tracked([](int x, int y, std::uint64_t sample) {
    return x >= left_at(sample) && x < left_at(sample) + kBallWidth && y >= kBallTop && y < kBallTop + kBallHeight;
  });
  ASSERT_EQ(tracks.size(), 1u);
  const SubjectTrack& track = tracks[0];
  ASSERT_EQ(track.places.size(), kSceneSamples);
  const double side = track.cell_side;
  for (const SubjectPlace& place : track.places) {
    EXPECT_NEAR(place.centre.x, left_at(place.sample) + kBallWidth / 2.0, side) << place.sample;
    EXPECT_NEAR(place.centre.y, kBallTop + kBallHeight / 2.0, side) << place.sample;
    EXPECT_LE(place.box.x, static_cast<std::uint32_t>(left_at(place.sample)));
    EXPECT_LE(place.box.y, static_cast<std::uint32_t>(kBallTop));
    EXPECT_GE(place.box.x + place.box.width, static_cast<std::uint32_t>(left_at(place.sample) + kBallWidth));
    EXPECT_GE(place.box.y + place.box.height, static_cast<std::uint32_t>(kBallTop + kBallHeight));
    EXPECT_EQ(place.share, 1) << "nothing else differs";
    EXPECT_EQ(place.fill, 1) << "a rectangle fills its box";
    EXPECT_NEAR(place.contrast, 100.0 / 255, 0.1);
    EXPECT_FALSE(place.is_cut_off);
  }
  EXPECT_NEAR(track.extent, left_at(kSceneSamples - 1) - left_at(0), 2 * side);
  EXPECT_NEAR(track.size(), std::sqrt(kBallWidth * kBallHeight), 2 * side);
  EXPECT_FALSE(track.is_scraps());
  EXPECT_FALSE(track.flickers);
  EXPECT_TRUE(track.rests.empty());
  std::size_t sum = 0;
  std::set<std::size_t> swept;
  for (const SubjectPlace& place : track.places) {
    sum += place.cells.size();
    swept.insert(place.cells.begin(), place.cells.end());
  }
  EXPECT_DOUBLE_EQ(track.covered_share(),
                   static_cast<double>(sum) / static_cast<double>(swept.size() * kSceneSamples));
}

// Its legs part and close, and it goes slower in the end.
TEST(Subject, DoesNotRestWhileItWalks) {
  const auto tracks = tracked([](int x, int y, std::uint64_t sample) {
    const auto k = static_cast<int>(sample);
    const int middle = k < 20 ? 20 + 3 * k : 50 + 3 * k / 2;
    const int apart = 5 + std::abs(k % 10 - 5) * 2;
    const bool is_leg = std::abs(std::abs(x - middle) - apart) < 5 && y >= kBallTop && y < kBallTop + 40;
    return is_leg || (std::abs(x - middle) <= apart && y >= kBallTop && y < kBallTop + 5);
  });
  ASSERT_EQ(tracks.size(), 1u);
  EXPECT_EQ(tracks[0].places.size(), kSceneSamples);
  EXPECT_TRUE(tracks[0].rests.empty());
}

TEST(Subject, IsCutOffAtTheBorder) {
  const auto tracks = tracked([](int x, int y, std::uint64_t sample) {
    return x >= left_at(sample) - 10 && x < left_at(sample) + kBallWidth && y >= 0 && y < kBallHeight;
  });
  ASSERT_EQ(tracks.size(), 1u);
  for (const SubjectPlace& place : tracks[0].places) EXPECT_TRUE(place.is_cut_off);
}

TEST(Subject, IsCutOffAtTheBorderOfItsRegion) {
  const auto tracks = tracked(
      [](int x, int y, std::uint64_t sample) {
        return x >= left_at(sample) && x < left_at(sample) + kBallWidth && y >= kBallTop && y < kBallTop + kBallHeight;
      },
      {80, 0, 80, 120});
  ASSERT_EQ(tracks.size(), 1u);
  std::size_t whole = 0;
  for (const SubjectPlace& place : tracks[0].places) {
    const int left = left_at(place.sample);
    if (left < 79) {
      EXPECT_TRUE(place.is_cut_off) << left;
    } else if (left > 84 && left + kBallWidth < 155) {
      EXPECT_FALSE(place.is_cut_off) << left;
    }
    whole += place.is_cut_off ? 0 : 1;
  }
  EXPECT_GT(whole, 5u);
}

// A slanted line, beside something large that stays where it is.
TEST(Subject, IsScrapsWhereItIsThinAndLittleOfWhatDiffers) {
  const auto tracks = tracked([](int x, int y, std::uint64_t sample) {
    const int along = x - left_at(sample);
    const bool is_line = along >= 0 && along < 24 && std::abs(y - 20 - along) < 2;
    return is_line || (x >= 40 && x < 120 && y >= 70 && y < 110);
  });
  ASSERT_EQ(tracks.size(), 1u);
  EXPECT_GT(tracks[0].extent, 60);
  EXPECT_TRUE(tracks[0].is_scraps());
}

// One comes in from below and stays, cut off and never apart from itself; the other one passes by, half as far.
TEST(Subject, IsSeenAsAWholeOnItsWay) {
  const auto comes_in = [](int x, int y, std::uint64_t sample) {
    return x >= 10 && x < 40 && y >= std::max(20, 118 - 4 * static_cast<int>(sample));
  };
  const auto passes = [](int x, int y, std::uint64_t sample) {
    const int left = 80 + static_cast<int>(sample) / 2;
    return x >= left && x < left + 12 && y >= 10 && y < 22;
  };
  const auto alone = tracked(comes_in);
  const auto both = tracked(
      [&](int x, int y, std::uint64_t sample) { return comes_in(x, y, sample) || passes(x, y, sample); });
  EXPECT_LT(alone[0].places.back().centre.x, 40) << "where there is no other";
  EXPECT_GT(both[0].places.back().centre.x, 80);
  EXPECT_LT(both[0].extent, alone[0].extent / 2);
}

// Two that overlap for a while, each in front of the other in part.
TEST(Subject, GoesOnAsItCameWhereWaysCross) {
  const auto right_at = [](std::uint64_t sample) { return 126 - 3 * static_cast<int>(sample); };
  const auto tracks = tracked([&](int x, int y, std::uint64_t sample) {
    const auto is_in = [&](int left, int top) {
      return x >= left && x < left + kBallWidth && y >= top && y < top + kBallHeight;
    };
    return is_in(left_at(sample), kBallTop) || is_in(right_at(sample), kBallTop + 6);
  });
  ASSERT_EQ(tracks[0].others.size(), 1u);
  for (const SubjectTrack* track : {&tracks[0], &tracks[0].others[0]}) {
    const bool goes_right = track->places.front().centre.x < 80;
    EXPECT_GT(track->places.size(), kSceneSamples - 12);
    for (const SubjectPlace& place : track->places) {
      const int left = goes_right ? left_at(place.sample) : right_at(place.sample);
      EXPECT_NEAR(place.centre.x, left + kBallWidth / 2.0, track->cell_side) << place.sample;
    }
  }
  EXPECT_NE(tracks[0].places.front().centre.x < 80, tracks[0].others[0].places.front().centre.x < 80);
}

}  // namespace
}  // namespace nutik
