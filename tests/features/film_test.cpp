// Films whose functions, masks and speed change: when frames are exposed and with what, in numbers worked out by hand.
#include <gtest/gtest.h>

#include "capture/error.hpp"
#include "exposure/function_text.hpp"
#include "features/film/film_request.hpp"
#include "session/requests/named_inputs.hpp"
#include "support/messages.hpp"

namespace nutik::test {
namespace {

const Timeline kFilmTimeline = Timeline::constant({100, 1}, {360, 1}, 100);  // one second, 10 ms each

FramesRequest film(const char* angle = "180") {
  FramesRequest request;
  request.exposure.gains = PlainInterval();
  request.rate = {10, 1};
  request.angle = Rational::parse(angle, "angle");
  return request;
}

FilmCurve curve_of(std::string_view text) { return FilmCurve::parse(text, "ramp.csv", film().film_times()); }

Frames frames_on(std::string_view curve, const char* angle = "180") {
  FramesRequest request = film(angle);
  request.curve = curve_of(curve);
  return frames_of(request, kFilmTimeline);
}

constexpr std::int64_t kMs = 1'000'000;

TEST(FilmCurve, SaysWhenFramesAreExposed) {
  // Twice as fast for half a second, then backwards at the same speed, then still.
  const Frames frames = frames_on("0s,0s # begins\n\n 0.5s , 1s\r\n10f,0.0s\n1.2s,0ms\n");
  EXPECT_EQ(frames.count, 12u);
  EXPECT_EQ(frames.exposure(0), (Exposure{0, 100 * kMs}));
  EXPECT_EQ(frames.exposure(4), (Exposure{800 * kMs, 900 * kMs}));
  EXPECT_EQ(frames.exposure(5), (Exposure{900 * kMs, 1000 * kMs}));  // backwards from 1 s
  EXPECT_EQ(frames.exposure(9), (Exposure{100 * kMs, 200 * kMs}));
  EXPECT_EQ(frames.exposure(10), (Exposure{0, 1})) << "still: the light of one moment";
  EXPECT_EQ(frames.exposure(11), (Exposure{0, 1}));
  EXPECT_EQ(frames.warning, "");
}

// Open for a whole frame, which turns round in its middle: it sees what the curve passes.
TEST(FilmCurve, ThatTurnsRoundExposesToTheTurn) {
  const Frames frames = frames_on("0s,0.2s\n0.15s,0.5s\n0.3s,0.2s\n", "360");
  EXPECT_EQ(frames.count, 3u);
  EXPECT_EQ(frames.exposure(0), (Exposure{200 * kMs, 400 * kMs}));
  EXPECT_EQ(frames.exposure(1), (Exposure{400 * kMs, 500 * kMs}));
  EXPECT_EQ(frames.exposure(2), (Exposure{200 * kMs, 400 * kMs}));
}

TEST(FilmCurve, OfConstantSpeedIsThatSpeed) {
  FramesRequest request = film();
  request.rate = {30000, 1001};
  const Frames plain = frames_of(request, kFilmTimeline);
  request.curve = FilmCurve::parse("0s,0s\n1s,1s", "line.csv", request.film_times());
  const Frames curved = frames_of(request, kFilmTimeline);
  ASSERT_EQ(curved.count, plain.count);
  for (std::uint64_t k = 0; k < plain.count; ++k) EXPECT_EQ(curved.exposure(k), plain.exposure(k)) << k;
}

TEST(FilmCurve, ThatLeavesTheCaptureStandsStillThereAndIsTold) {
  const Frames frames = frames_on("0s,-0.2s\n1.5s,1.3s\n", "360");
  EXPECT_EQ(frames.count, 15u);
  EXPECT_EQ(frames.exposure(1), (Exposure{0, 1}));
  EXPECT_EQ(frames.exposure(2), (Exposure{0, 100 * kMs}));
  EXPECT_EQ(frames.exposure(12), (Exposure{1000 * kMs - 1, 1000 * kMs}));
  EXPECT_EQ(frames.warning,
            "ramp.csv leaves the capture, which lasts 1 s, in frames 0-1, 12-14; there the film shows what is left "
            "within it, or stands still at its first or last moment");
}

TEST(FilmCurve, NamesTheLineOfAMistake) {
  const auto message = [](std::string_view text) { return message_of<InputError>([&] { return curve_of(text); }); };
  EXPECT_EQ(message("0s,0s\n1s,0.5s\n0.5s,1s"),
            "ramp.csv:3: the film's time 500 ms is not after 1 s; points are in order of the film's time");
  EXPECT_EQ(message("0s,0s\n1s,0.5s\n\n1s,1s"),
            "ramp.csv:4: the film's time 1 s is not after 1 s; points are in order of the film's time");
  EXPECT_EQ(message("0.5s,0s\n1s,0.5s"), "ramp.csv:1: the first point is at 500 ms of the film; a curve begins at 0s");
  EXPECT_EQ(message("0s,0s\n1,0.5s"),
            "ramp.csv:2: the film's time '1' is no time; write a number and a unit: 0.4s, 10ms, 250us, 1/100s, 0:01.5, "
            "or 37f "
            "for pictures of the clip");
  EXPECT_EQ(message("0s,0s\n1s 0.5s"),
            "ramp.csv:2: '1s 0.5s' is no point; write a time of the film and one of the capture: 1.5s,0.4s");
  EXPECT_EQ(message("-1s,0s"), "ramp.csv:1: the film's time -1s lies before the film, which begins at 0s");
  EXPECT_EQ(
      message("0s,0s # alone"),
      "ramp.csv is too short, with 1 of the points that a curve has: two or more, a line each: 0s,0.2s and 2s,0.7s "
      "show half a second of the capture in two of the film");
  EXPECT_EQ(message(std::string("0s\0,0s\n1s,1s", 12)),
            "ramp.csv holds a zero byte: this is no text file, or one in UTF-16; save it as UTF-8");
  EXPECT_EQ(message("\xEF\xBB\xBF" "0s,0s\n1s"),
            "ramp.csv:2: '1s' is no point; write a time of the film and one of the capture: 1.5s,0.4s");
  const auto refusal = [](std::string_view text) { return message_of<UsageError>([&] { return frames_on(text); }); };
  expect_says(refusal("0s,0f\n1s,200f"), "ramp.csv: picture 200 is outside the capture");
  expect_says(refusal("0s,0s\n10ms,1s"), "ramp.csv lasts 10 ms, which are 0 frames");
}

FunctionKey key(std::int64_t film_ns, const std::string& name, const std::string& text) {
  return {film_ns, name, read_functions(text, name).functions};
}

FramesRequest keyed_film() {
  FramesRequest request = film();
  request.keys.functions = {key(100 * kMs, "a.fn", "M0 [-1:0], [0:1], [100000000:1], [100000001:0]"),
                            key(500 * kMs, "b.fn", "M0 [-1:0], [0:3], [300000000:2], [300000001:0]")};
  request.exposure.gains = request.keys.functions.front().functions;
  return request;
}

TEST(KeyFrames, MoveControlPointsWithTheFilm) {
  const FramesRequest request = keyed_film();
  request.keys.check();
  const Frames frames = frames_of(request, kFilmTimeline);
  // The longest key needs 300 ms and 1 ns of the second.
  EXPECT_EQ(frames.count, 7u);
  const auto text = [&](std::uint64_t frame) {
    return function_text(0, std::get<Shared<FunctionSet>>(exposure_of(request, frames, frame).gains)->at(0));
  };
  EXPECT_EQ(text(0), "M0 [-1:0], [0:1], [100000000:1], [100000001:0]") << "before the first key";
  EXPECT_EQ(text(2), "M0 [-1:0], [0:1.5], [150000000:1.25], [150000001:0]");
  EXPECT_EQ(text(5), "M0 [-1:0], [0:3], [300000000:2], [300000001:0]");
  EXPECT_EQ(text(6), text(5)) << "after the last one";
}

TEST(KeyFrames, RefuseWhatIsNoAnimation) {
  FramesRequest request = keyed_film();
  const auto message = [&] { return message_of<Error>([&] { request.keys.check(); }); };
  EXPECT_EQ(message(), "");
  request.keys.functions[1].film_ns = 100 * kMs;
  EXPECT_EQ(message(), "the key b.fn at 100 ms is not after a.fn at 100 ms; keys are in order of time");
  request.keys.functions[1] = key(500 * kMs, "c.fn", "M0 [0:1]\nM7 [0:1]\n");
  EXPECT_EQ(message(), "c.fn has a function M7 and a.fn has none; keys have functions for the same mask values");
  request.keys.functions.pop_back();
  EXPECT_EQ(message(),
            "a.fn is the only key of functions; two or more make them change, and one alone is a file of functions "
            "for the whole film");
}

TEST(FrameRanges, AreReadInTheWordsOfFarms) {
  const auto below = [](std::string_view text, std::uint64_t count = 1000) {
    return ranges_text(FrameRanges::parse(text, "--frames").below(count));
  };
  EXPECT_EQ(below("7"), "7");
  EXPECT_EQ(below("1-10"), "1-10");
  EXPECT_EQ(below("1-10x3"), "1, 4, 7, 10");
  EXPECT_EQ(below("1-10y3"), "2-3, 5-6, 8-9");
  EXPECT_EQ(below("10-1x4"), "2, 6, 10");
  EXPECT_EQ(below("10-1y4"), "1, 3-5, 7-9");
  EXPECT_EQ(below("1-10:5"), "1-10");
  EXPECT_EQ(below("1-100x2,105", 9), "1, 3, 5, 7") << "clamped";
  EXPECT_EQ(below("5, 3-4 4-6"), "3-6");
  EXPECT_EQ(below("20-30", 20), "");
  EXPECT_EQ(below("0-999999999999"), "0-999");
  for (const char* text : {"", ",", "a", "1-", "-5", "1-5x0", "1-5x", "1-5z2", "1x2", "1-5x2x2", "1.5",
                           "1000000000000000000000"}) {
    EXPECT_THROW(static_cast<void>(FrameRanges::parse(text, "--frames")), UsageError) << text;
  }
}

TEST(FrameRanges, ChooseFramesOfTheWholeFilm) {
  FramesRequest request = film();
  request.numbers = FrameRanges::parse("8-20", "--frames");
  const Frames frames = frames_of(request, kFilmTimeline);
  EXPECT_EQ(frames.count, 10u);
  EXPECT_EQ(frames.numbers, (std::vector<std::uint64_t>{8, 9}));
  EXPECT_EQ(frames.span(), (Exposure{800 * kMs, 950 * kMs}));
  FunctionSet functions;
  functions.emplace(std::uint8_t{0}, GainFunction({{0, 1}, {5 * kMs, 1}, {5 * kMs + 1, 0}}));
  FramesRequest by_functions = request;
  by_functions.exposure.gains = Shared(std::move(functions));
  EXPECT_EQ(frames_of(by_functions, kFilmTimeline).span(), (Exposure{800 * kMs, 905 * kMs + 1}))
      << "whatever the angle";
  request.numbers = FrameRanges::parse("10-20", "--frames");
  EXPECT_EQ(message_of<UsageError>([&] { return frames_of(request, kFilmTimeline); }),
            "none of the frames 10-20 is there: the film has 10, numbered from 0 to 9");
}

TEST(Frames, OfTwoOrThreePicturesShowWhatMovesSoOften) {
  const auto seen = [](Rational filmed, const char* angle, Rational rate = {24, 1}) {
    const Timeline timeline = Timeline::constant(filmed, {360, 1}, static_cast<std::uint64_t>(filmed.numerator));
    FramesRequest request = film(angle);
    request.rate = rate;
    return seen_together(frames_of(request, timeline), timeline);
  };
  EXPECT_EQ(seen({30, 1}, "180"), (SampleRange{0, 30}));  // every other frame has two
  EXPECT_EQ(seen({60, 1}, "180"), (SampleRange{0, 59}));
  EXPECT_EQ(seen({60, 1}, "360", {30, 1}), (SampleRange{0, 60}));
  EXPECT_EQ(seen({30, 1}, "360", {30, 1}), std::nullopt) << "each its own picture";
  EXPECT_EQ(seen({24, 1}, "180"), std::nullopt);
  EXPECT_EQ(seen({240, 1}, "180"), std::nullopt) << "five or six join";
}

TEST(Frames, OfFunctionsOverAllOfTheCaptureAreOne) {
  constexpr std::int64_t kEnd = 1'000'000'000;
  FramesRequest request = film("180");
  request.exposure.gains = Shared(FunctionSet{{0, GainFunction({{-1, 0}, {0, 1}, {kEnd, 1}, {kEnd + 1, 0}})}});
  const Frames frames = frames_of(request, Timeline::constant({10, 1}, {360, 1}, 10));
  EXPECT_EQ(frames.count, 1u);
  EXPECT_EQ(frames.span(), (Exposure{0, kEnd}));
}

}  // namespace
}  // namespace nutik::test
