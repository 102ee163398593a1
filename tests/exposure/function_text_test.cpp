#include "exposure/function_text.hpp"

#include <gtest/gtest.h>

#include "capture/error.hpp"
#include "exposure/function_file.hpp"
#include "exposure/shutter_shape.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

GainFunction read_back(const std::string& text, std::uint8_t tag) {
  const FunctionFile file = parse_functions(text);
  EXPECT_FALSE(file.has_errors()) << file.report("text");
  EXPECT_EQ(file.functions.size(), 1u);
  return file.functions.at(tag).function;
}

TEST(FunctionText, WritesJumpsAsSteps) {
  EXPECT_EQ(function_text(128, GainFunction::boxcar(400'000'000, 410'000'000)),
            "M128 [399999999:0], [400000000:1], [410000000:1], [410000001:0]");
  // From the capture's start on, so that it can be moved; the step before it is nothing to warn of.
  const GainFunction at_start = GainFunction::boxcar(0, 10'000'000);
  EXPECT_EQ(function_text(0, at_start), "M0 [-1:0], [0:1], [10000000:1], [10000001:0]");
  EXPECT_FALSE(summarize(with_steps(at_start), 20'000'000).reaches_before_capture);
  EXPECT_EQ(summarize(with_steps(at_start), 20'000'000).support_ns, 10'000'001);
  EXPECT_EQ(function_text(7, GainFunction({{-10, 0}, {-10, -2}, {5, -2}, {5, 0.5}, {9, 0}})),
            "M7 [-11:0], [-10:-2], [5:-2], [6:0.5], [9:0]");
  EXPECT_EQ(function_text(1, GainFunction({{5, 0.1}})), "M1 [5:0.1]");
}

TEST(FunctionText, IsReadBackIdentically) {
  for (const char* shape : {"box", "trapezoid:0.25", "triangle", "gaussian", "hann", "strobe:7",
                            "spline:0=0.25,0.1=1,0.9=-1e-7,1=0.5"}) {
    for (const std::int64_t begin_ns : {-5'000LL, 0LL, 400'000'000LL}) {
      const GainFunction function = ShutterShape::parse(shape).function({begin_ns, begin_ns + 10'000'000});
      const GainFunction read = read_back(function_text(200, function), 200);
      EXPECT_EQ(read, with_steps(function)) << shape;
      EXPECT_EQ(read_back(function_text(200, read), 200), read) << shape;
    }
  }
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    const GainFunction function = random_function(random, random_timeline(random, 20));
    try {
      EXPECT_EQ(read_back(function_text(3, function), 3), with_steps(function)) << "seed " << seed;
    } catch (const UsageError&) {  // no room for a step
    }
  }
}

// A step adds half a nanosecond of light at each jump.
TEST(FunctionText, StepsChangeNextToNothing) {
  const GainFunction strobe = ShutterShape::parse("strobe:3").function({1'000, 6'000});
  const GainSummary jumps = summarize(strobe, 10'000), steps = summarize(with_steps(strobe), 10'000);
  EXPECT_EQ(jumps.integral_ns, 3'000.0);
  EXPECT_EQ(steps.integral_ns, 3'003.0);
  EXPECT_EQ(steps.support_ns, 3'006);
}

TEST(FunctionText, SaysWhereThereIsNoRoomForAStep) {
  const GainFunction flashes({{4, 0}, {4, 1}, {5, 1}, {5, 0}, {6, 0}, {6, 1}, {7, 1}, {7, 0}});
  EXPECT_EQ(message_of<UsageError>([&] { return function_text(0, flashes); }),
            "the gain jumps twice round 7 ns: in a function file a jump takes 1 ns, and there is no room for that");
}

}  // namespace
}  // namespace nutik::test
