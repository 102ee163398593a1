// What bounds and scales are made of, from tables worked out by hand.
#include "render/function_course.hpp"

#include <gtest/gtest.h>

#include <array>

namespace nutik {
namespace {

// Two blocks with light between 0 and 1 in each sample: the first has sums from -0.25 to 0.75, both from -1.25 to 0.75.
TEST(FunctionCourse, FollowsTheLargestSumsThatLightCanCause) {
  constexpr std::array<double, 4> first_weights{0.5, -0.25, 0.0, 0.25};
  constexpr std::array<double, 5> first_boundaries{0.0, 0.5, 0.25, 0.25, 0.5};
  constexpr std::array<double, 2> second_weights{-1.0, 0.0};
  constexpr std::array<double, 3> second_boundaries{0.5, -0.5, -0.5};
  CourseMeter meter;
  meter.add({.span = {}, .weights = first_weights, .boundaries = first_boundaries, .before = {}}, {});
  meter.add({}, {});
  meter.add({.span = {}, .weights = second_weights, .boundaries = second_boundaries, .before = {}}, {});

  const FunctionCourse course = meter.course();
  EXPECT_EQ(course.magnitude, 2.0);
  EXPECT_EQ(course.compensated_magnitude, 2.0);
  EXPECT_EQ(course.extent, 1.25);
  EXPECT_EQ(course.partial_sums, 0.5 + 0.5 + 0.75 + 1.0);
  EXPECT_EQ(course.block_sums, 1.25);
  EXPECT_EQ(course.boundaries, 0.5 + 0.25 + 0.25 + 0.5 + 0.5 + 0.5);
  EXPECT_EQ(course.longest_block, 4.0);
  EXPECT_EQ(course.block_count, 2.0);
  EXPECT_EQ(course.sample_count, 6.0);
  EXPECT_EQ(course.weight_count, 4u) << "weights of 0 are never rounded";
  EXPECT_EQ(course.steady_magnitude, 0.0) << "none of the blocks is steady";
}

// A third is no float, and no two floats are one.
TEST(FunctionCourse, AddsUpWhatTablesMissOfBoundaries) {
  constexpr std::array<double, 2> weights{1.0 / 3, 0.25 - 1.0 / 3};
  constexpr std::array<double, 3> boundaries{0.0, 1.0 / 3, 0.25};
  CourseMeter meter;
  meter.add({.span = {}, .weights = weights, .boundaries = boundaries, .before = {}}, {});

  const double missed = std::abs(1.0 / 3 - static_cast<double>(static_cast<float>(1.0 / 3)));
  EXPECT_EQ(meter.course().boundary_errors(Precision::single_), missed);
  EXPECT_LT(meter.course().boundary_errors(Precision::compensated), 0x1p-24 * missed);
  EXPECT_EQ(meter.course().boundary_errors(Precision::double_), 0.0);
}

// Two samples whose boundaries are floats. The first one's light is in two sums, and both are rounded.
TEST(FunctionCourse, HasLinesOfWhatSumsLoseOfTheLightItself) {
  constexpr std::array<double, 2> weights{0.5, 0.25};
  constexpr std::array<double, 3> boundaries{0.0, 0.5, 0.75};
  CourseMeter meter;
  meter.add({.span = {}, .weights = weights, .boundaries = boundaries, .before = {}}, {});
  const std::vector<LightLine> lines = meter.course().single_lines;
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].constant, 0.0);
  EXPECT_EQ(lines[0].slope, 0x1p-24);
}

// A sample of next to no weight behind others: its boundaries err by much more than its light is.
TEST(FunctionCourse, HasLinesThatCountFewSamplesAsAConstant) {
  constexpr double kSmall = 0x1p-30;
  constexpr std::array<double, 3> weights{0.5, 0.25, kSmall};
  constexpr std::array<double, 4> boundaries{0.0, 0.5, 0.75, 0.75 + kSmall};
  CourseMeter meter;
  meter.add({.span = {}, .weights = weights, .boundaries = boundaries, .before = {}}, {});
  const std::vector<LightLine> lines = meter.course().single_lines;
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0].slope, 0.0);
  EXPECT_NEAR(lines[0].constant, 0x1p-23 * 0.75 + kSmall, kSmall * 1e-6);
  EXPECT_EQ(lines[1].slope, 0x1p-23);
  EXPECT_NEAR(lines[1].constant, kSmall, kSmall * 1e-6) << "all of the boundary that no float holds";
  EXPECT_EQ(lines[2].constant, 0.0);
}

TEST(FunctionCourse, HasNoLinesWhereLightIsTakenAway) {
  constexpr std::array<double, 2> weights{0.5, -0.25};
  constexpr std::array<double, 3> boundaries{0.0, 0.5, 0.25};
  CourseMeter meter;
  meter.add({.span = {}, .weights = weights, .boundaries = boundaries, .before = {}}, {});
  EXPECT_TRUE(meter.course().single_lines.empty());
}

}  // namespace
}  // namespace nutik
