// Which places of a track are shown together.
#include "scene/moments.hpp"

#include <gtest/gtest.h>

namespace nutik {
namespace {

// A subject of one cell of 8 pixels, found at these samples, so many pixels from the left.
SubjectTrack track_of(const std::vector<std::pair<std::uint64_t, std::size_t>>& found) {
  SubjectTrack track;
  track.cell_side = 8;
  track.cell_columns = 100;
  for (const auto& [sample, x] : found) {
    SubjectPlace& place = track.places.emplace_back();
    place.sample = sample;
    place.centre = {static_cast<double>(x), 4};
    place.contrast = 0.5;
    place.cells = {x / 8};
    place.solid = 1;
  }
  return track;
}

std::vector<std::uint64_t> samples_of(const std::vector<SubjectPlace>& places) {
  std::vector<std::uint64_t> samples;
  for (const SubjectPlace& place : places) samples.push_back(place.sample);
  return samples;
}

using Samples = std::vector<std::uint64_t>;

constexpr std::uint32_t kGap = 8;

TEST(Moments, AreSpreadEvenlyInTimeOrAlongTheWay) {
  const SubjectTrack track = track_of({{0, 4}, {10, 24}, {20, 44}, {30, 204}, {40, 404}});
  EXPECT_EQ(samples_of(choose_moments(track, 3, MomentSpacing::time, kGap)), (Samples{0, 20, 40}));
  EXPECT_EQ(samples_of(choose_moments(track, 3, MomentSpacing::distance, kGap)), (Samples{0, 30, 40}));
  EXPECT_EQ(samples_of(choose_moments(track, 1, MomentSpacing::time, kGap)), (Samples{20}));
}

// At the middle of the time nothing was found: what lies furthest from the others takes its place.
TEST(Moments, AreFilledUpWithTheFurthest) {
  const SubjectTrack track = track_of({{0, 4}, {20, 124}, {22, 204}, {24, 164}, {100, 404}});
  EXPECT_EQ(samples_of(choose_moments(track, 3, MomentSpacing::time, kGap)), (Samples{0, 22, 100}));
}

TEST(Moments, DoNotTouch) {
  const SubjectTrack track = track_of({{0, 4}, {10, 12}, {20, 20}, {30, 28}, {40, 36}});
  EXPECT_EQ(samples_of(choose_moments(track, 5, MomentSpacing::time, kGap)), (Samples{0, 20, 40}));
  EXPECT_EQ(samples_of(choose_moments(track, 5, MomentSpacing::time, 2 * kGap)), (Samples{0, 30}));
}

// What hangs is always near itself where it hangs: here one cell of eight.
TEST(Moments, MayBeNearEachOtherWhereTheSubjectHangs) {
  SubjectTrack track = track_of({{0, 0}, {10, 240}, {20, 480}});
  for (SubjectPlace& place : track.places) {
    const std::size_t first = 100 + place.cells.front();
    place.cells = {75};
    while (place.cells.size() < 8) place.cells.push_back(first + place.cells.size());
    place.solid = 8;
  }
  EXPECT_EQ(samples_of(choose_moments(track, 5, MomentSpacing::time, kGap)), (Samples{0, 10, 20}));
  for (SubjectPlace& place : track.places) place.is_cut_off = true;
  EXPECT_EQ(choose_moments(track, 5, MomentSpacing::time, kGap).size(), 1u);
}

// The border leaves one, two and three cells of a subject of four.
TEST(Moments, ShowAtLeastHalfOfTheSubject) {
  SubjectTrack track = track_of({{0, 0}, {10, 80}, {20, 240}, {30, 400}, {40, 640}});
  const std::vector<std::size_t> cells = {1, 4, 4, 4, 2};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    SubjectPlace& place = track.places[i];
    place.is_cut_off = cells[i] < 4;
    while (place.cells.size() < cells[i]) place.cells.push_back(place.cells.back() + 1);
    place.solid = place.cells.size();
  }
  EXPECT_EQ(samples_of(choose_moments(track, 5, MomentSpacing::time, kGap)), (Samples{10, 20, 30, 40}));
}

}  // namespace
}  // namespace nutik
