#include "session/requests/exposure_request.hpp"

#include <gtest/gtest.h>

#include <array>

#include "capture/error.hpp"
#include "features/film/film_request.hpp"
#include "features/series/series_request.hpp"
#include "session/requests/named_inputs.hpp"
#include "support/messages.hpp"

namespace nutik::test {
namespace {

const Timeline kTimeline = Timeline::constant({100, 1}, {360, 1}, 10);  // 10 ms each

StatedTime time(std::string_view text) { return StatedTime::parse(text, "time"); }

ExposureRequest plain(std::string_view start, std::string_view length, const std::string& shape = "box") {
  ExposureRequest request;
  request.start = time(start);
  request.gains = PlainInterval{time(length), Shutter(ShutterShape::parse(shape), 1e-3)};
  return request;
}

// M0 exposes the first 20 ms, M255 the 10 ms after them.
constexpr std::string_view kTwoFunctions =
    "M0 [0:1], [20000000:1], [20000001:0]\nM255 [20000000:0], [20000001:1], [30000000:1], [30000001:0]\n";

ExposureRequest with_functions(std::string_view text, const Mask& mask) {
  ExposureRequest request;
  request.gains = read_functions(text, "two.fn").functions;
  request.mask = Shared(MaskWithRegions(mask));
  return request;
}

TEST(ExposureRequest, IsEqualToOneThatMeansTheSame) {
  EXPECT_EQ(plain("0.4s", "10ms"), plain("400ms", "1/100s"));
  EXPECT_EQ(plain("0s", "10ms", "trapezoid:0.25"), plain("0s", "10ms", "trapezoid:1/4"));
  EXPECT_NE(plain("0s", "10ms", "hann"), plain("0s", "10ms", "gaussian"));
  EXPECT_NE(plain("0s", "10ms"), plain("0s", "11ms"));
  ExposureRequest brighter = plain("0s", "10ms");
  brighter.gain = 2.0;
  EXPECT_NE(plain("0s", "10ms"), brighter);
  EXPECT_EQ(DelayRequest::parse("a.tif:0s..1s", "delay"), DelayRequest::parse("a.tif:1000ms", "delay"));
  EXPECT_NE(DelayRequest::parse("a.tif:0s..1s", "delay"), DelayRequest::parse("b.tif:0s..1s", "delay"));
  EXPECT_EQ(message_of<UsageError>([] { return DelayRequest::of_times(2, 2, std::array<std::int64_t, 3>{0, 1, 2}); }),
            "there are 3 delays for 2 x 2 pixels; each pixel needs one");
}

TEST(ExposureRequest, IsEqualToOneWithFunctionsAndMaskThatHoldTheSame) {
  const ExposureRequest request = with_functions(kTwoFunctions, {2, 1, {0, 255}});
  EXPECT_EQ(request, ExposureRequest(request));
  EXPECT_EQ(request, with_functions(kTwoFunctions, {2, 1, {0, 255}})) << "read twice";
  EXPECT_NE(request, with_functions(kTwoFunctions, {2, 1, {255, 0}}));
  EXPECT_NE(request, with_functions("M0 [0:1], [1000:0]", {2, 1, {0, 255}}));
}

// Ends that are no whole nanoseconds are not rounded before what lies between them.
TEST(ExposureRequest, RoundsEachDelayOnce) {
  const auto delays = [](std::string_view words, std::uint32_t rows) {
    return delays_of(DelayRequest::parse(words, "delay"), {1, rows, 1})->delays_ns;
  };
  EXPECT_EQ(delays("rows:0ns..5/2000000000s", 3), (std::vector<std::int64_t>{0, 1, 3}));
  EXPECT_EQ(delays("rows:-5/2000000000s..0ns", 3), (std::vector<std::int64_t>{-2, -1, 0}));
  EXPECT_EQ(delays("rows:1/3000000000s..2/3000000000s", 1), (std::vector<std::int64_t>{0}));
  // As far apart, and with as large denominators, as times can be written.
  EXPECT_EQ(delays("rows:1/999999999999989s..9999999999999/2503s", 3)[1], 1'997'602'876'547'942'469);
}

TEST(ExposureRequest, MakesTheFunctionsThatTheMaskUses) {
  const FunctionSet all = functions_of(with_functions(kTwoFunctions, {2, 1, {0, 255}}), kTimeline);
  EXPECT_EQ(all.size(), 2u);
  const FunctionSet one = functions_of(with_functions(kTwoFunctions, {2, 1, {255, 255}}), kTimeline);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one.begin()->first, 255);
}

TEST(ExposureRequest, StartsFunctionsAtItsStart) {
  ExposureRequest request = with_functions(kTwoFunctions, {1, 1, {0}});
  const FunctionSet at_zero = functions_of(request, kTimeline);
  request.start = time("3f");
  const FunctionSet later = functions_of(request, kTimeline);
  EXPECT_EQ(later.at(0), at_zero.at(0).shifted(30'000'000));
  EXPECT_EQ(functions_end_ns(request), 20'000'001);
}

TEST(ExposureRequest, RefusesAnIntervalOutsideTheCapture) {
  EXPECT_THROW(static_cast<void>(functions_of(plain("0.1s", "10ms"), kTimeline)), UsageError);
  EXPECT_THROW(static_cast<void>(functions_of(plain("-20ms", "10ms"), kTimeline)), UsageError);
}

TEST(FunctionInput, TellsOfAllMistakesAndReturnsWarnings) {
  EXPECT_THROW(static_cast<void>(read_functions("M0 [2:1], [1:1]", "bad.fn")), InputError);
  EXPECT_TRUE(read_functions("M0 [0:1], [1000:0]", "good.fn").warnings.empty());
}

TEST(SeriesRequest, StartsWithinTheCapture) {
  const SeriesRequest every{time("25ms"), std::nullopt};
  const std::vector<StatedTime> starts = starts_of(every, plain("0s", "10ms"), kTimeline);
  ASSERT_EQ(starts.size(), 4u);
  EXPECT_EQ(starts[3], time("75ms"));
  EXPECT_EQ(starts_of({time("2f"), 3}, plain("1f", "1f"), kTimeline).back(), time("5f"));
}

// No nanosecond is exposed twice, or not at all, by exposures that follow each other.
TEST(SeriesRequest, OfTimesBesideEachOtherLeavesNoGaps) {
  const ExposureRequest request = plain("1/7ms", "1/300s");
  for (const char* every : {"1/300s", "1f"}) {
    const Timeline timeline = Timeline::constant({300, 1}, {180, 1}, 30);
    const std::vector<StatedTime> starts = starts_of({time(every), std::nullopt}, request, timeline);
    ASSERT_EQ(starts.size(), 29u);
    for (std::size_t k = 1; k < starts.size(); ++k) {
      const Exposure before = plain_interval(starts[k - 1], time("1/300s"), timeline);
      EXPECT_EQ(plain_interval(starts[k], time("1/300s"), timeline).start_ns, before.end_ns) << every << k;
    }
  }
}

TEST(SeriesRequest, SaysHowManyWouldFit) {
  const auto error = error_of<UsageError>([] { return starts_of({time("2f"), 9}, plain("1f", "1f"), kTimeline); });
  ASSERT_TRUE(error) << "more exposures than the capture has room for";
  EXPECT_EQ(error->advice(), "; `count 5` at most");
  EXPECT_THROW(static_cast<void>(starts_of({time("2f"), {}}, plain("0s", "1s"), kTimeline)),
               UsageError);
}

TEST(FramesRequest, CountsFramesThatEndWithinTheCapture) {
  FramesRequest request;
  request.exposure = plain("0s", "0s");
  request.rate = {50, 1};  // 20 ms, open for 10
  const Frames frames = frames_of(request, kTimeline);
  EXPECT_EQ(frames.count, 5u);
  EXPECT_EQ(frames.times.exposure(1), (Exposure{20'000'000, 30'000'000}));
  EXPECT_TRUE(frames.warning.empty());
  request.to = time("2s");
  EXPECT_EQ(frames_of(request, kTimeline).count, 5u);
  EXPECT_FALSE(frames_of(request, kTimeline).warning.empty()) << "the end lies behind the capture's";
  request.from = time("95ms");
  EXPECT_THROW(static_cast<void>(frames_of(request, kTimeline)), UsageError);
}

}  // namespace
}  // namespace nutik::test
