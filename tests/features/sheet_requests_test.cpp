#include <gtest/gtest.h>

#include "features/sheets/sheet_request.hpp"
#include "support/messages.hpp"

namespace nutik::test {
namespace {

const Timeline kSheetTimeline = Timeline::constant({100, 1}, {180, 1}, 10);  // 10 ms each, open for 5

StatedTime stated(std::string_view text) { return StatedTime::parse(text, "time"); }

FunctionSet box(std::int64_t from_ns, std::int64_t to_ns) {
  FunctionSet functions;
  functions.emplace(0, GainFunction::boxcar(from_ns, to_ns));
  return functions;
}

ExposureRequest exposing_box(std::int64_t from_ns, std::int64_t to_ns) {
  ExposureRequest request;
  request.gains = Shared(box(from_ns, to_ns));
  return request;
}

TEST(SweepRequest, VariesTheFirstRangeFastest) {
  const SweepRange shift{SweepParameter::shift, {0, 1}, {20, 1}, {10, 1}, false};
  const SweepRange gain{SweepParameter::gain, {1, 2}, {1, 1}, {1, 2}, false};
  const SweepRequest sweep{{shift, gain}};
  const std::vector<SweepPoint> points = sweep.points();
  ASSERT_EQ(points.size(), 6u);
  EXPECT_EQ(points[1], (SweepPoint{1, 0}));
  EXPECT_EQ(points[3], (SweepPoint{0, 1}));
  EXPECT_EQ(sweep.label(points[0]), "as it is, gain × 0.5");
}

TEST(SweepRequest, AppliesItsValues) {
  const SweepRequest pictures{{{SweepParameter::shift, {-1, 1}, {1, 1}, {1, 1}, true}}};
  EXPECT_EQ(pictures.varied(exposing_box(20'000'000, 30'000'000), {2}, kSheetTimeline), box(30'000'000, 40'000'000));
  const SweepRequest stretch{{{SweepParameter::stretch, {1, 1}, {2, 1}, {1, 1}, false}}};
  EXPECT_EQ(stretch.varied(exposing_box(20'000'000, 30'000'000), {1}, kSheetTimeline), box(20'000'000, 40'000'000));
}

TEST(SweepRequest, GoesFromPictureToPictureWhereTimesAreIrregular) {
  const Timeline timeline = Timeline::irregular({0, 10, 40, 60, 100}, {180, 1});
  const SweepRequest shifts{{SweepRange::parse(SweepParameter::shift, "-1f..3f/1f", "shift")}};
  ExposureRequest plain;
  plain.start = stated("1f");
  plain.gains = PlainInterval{stated("1f"), Shutter()};
  EXPECT_EQ(shifts.varied(plain, {0}, timeline), box(0, 5));
  EXPECT_EQ(shifts.varied(plain, {3}, timeline), box(60, 80));
  // From a time of picture 1, and of functions; behind the end by the mean period.
  plain.start = stated("12ns");
  plain.gains = PlainInterval{stated("4ns"), Shutter()};
  EXPECT_EQ(shifts.varied(plain, {2}, timeline), box(42, 46));
  EXPECT_EQ(shifts.varied(exposing_box(3, 8), {2}, timeline), box(13, 18));
  plain.start = stated("3f");
  EXPECT_EQ(shifts.varied(plain, {4}, timeline), box(168, 172));
}

TEST(SweepRequest, OfTimesInThirdsOfNanosecondsNeverDrifts) {
  const Rational step = stated("1/300s").modest_nanoseconds();
  EXPECT_EQ(step, (Rational{10'000'000, 3}));
  const SweepRange range{SweepParameter::shift, {0, 1}, {1'000'000'000, 1}, step, false};
  ASSERT_EQ(range.count(), 301u);
  for (std::uint64_t k = 0; k <= 300; ++k)
    ASSERT_EQ(range.shift_ns(k), static_cast<std::int64_t>((k * 20'000'000 + 3) / 6)) << k;
  EXPECT_EQ(range.label(150), "+500 ms");
  EXPECT_EQ(stated("1/999999999999999ns").modest_nanoseconds(), (Rational{0, 1})) << "rounded";
  const SweepRequest sweep{{range}};
  EXPECT_EQ(sweep.varied(exposing_box(0, 10), {300}, kSheetTimeline), box(1'000'000'000, 1'000'000'010));
}

TEST(ContactRequest, CountsPicturesOrTimes) {
  EXPECT_EQ(exposures_of({}, kSheetTimeline).size(), 10u);
  const std::vector<Exposure> pictures = exposures_of({stated("1f"), stated("4f"), {}}, kSheetTimeline);
  EXPECT_EQ(pictures, (std::vector<Exposure>{
                          {10'000'000, 15'000'000}, {50'000'000, 55'000'000}, {90'000'000, 95'000'000}}));
  const std::vector<Exposure> times = exposures_of({stated("0s"), stated("40ms"), stated("30ms")}, kSheetTimeline);
  EXPECT_EQ(times,
            (std::vector<Exposure>{{0, 30'000'000}, {40'000'000, 70'000'000}, {80'000'000, 110'000'000}}));
  EXPECT_EQ(labels_of(times, kSheetTimeline)[1], "40 ms   4f");
}

// Each ends where the next begins, whatever is rounded.
TEST(ContactRequest, OfTimesBesideEachOtherLeavesNoGaps) {
  for (const char* length : {"1/300s", "1001/240000s"}) {
    const std::vector<Exposure> all = exposures_of({stated("1/7s"), stated(length), stated(length)},
                                                   Timeline::constant({1000, 1}, {360, 1}, 300));
    ASSERT_GT(all.size(), 30u);
    for (std::size_t k = 1; k < all.size(); ++k) EXPECT_EQ(all[k].start_ns, all[k - 1].end_ns) << length << k;
  }
}

TEST(ContactRequest, SaysWhichStepFitsASheet) {
  const auto error = error_of<UsageError>([&] {
    return exposures_of({stated("0s"), stated("1us"), {}}, kSheetTimeline);
  });
  ASSERT_TRUE(error) << "a sheet has no room for 100 000 pictures";
  expect_says(error->advice(), "take `every 250us` or more");
}

}  // namespace
}  // namespace nutik::test
