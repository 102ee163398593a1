// Errors of pictures against numbers worked out by hand, and against a second computation.
#include "render/picture_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "render/reference_renderer.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

// A capture of 4 x 1 grey pixels with linear light, exposed as a whole.
class PictureErrors : public testing::Test {
 protected:
  PictureErrors() {
    format_.shape = {4, 1, 1};
    format_.transfer = Transfer::linear();
    const Rasters rasters(2, std::vector<std::byte>(4, std::byte{100}));
    const MemoryCapture capture(format_, Timeline::constant({10, 1}, Timeline::kFullShutter, 2), rasters, 2);
    plan_ = make_plan(capture, {{0, GainFunction::boxcar(0, 200'000'000)}}, Mask::uniform(4, 1, 0), {});
  }

  [[nodiscard]] Picture light(const std::vector<double>& values) const {
    Picture picture(format_.shape, ValueType::light64, 0);
    std::ranges::copy(values, picture.values<double>().begin());
    return picture;
  }
  [[nodiscard]] Picture codes(const std::vector<int>& values) const {
    Picture picture(format_.shape, ValueType::code8, 255);
    for (std::size_t i = 0; i < values.size(); ++i)
      picture.values<std::uint8_t>()[i] = static_cast<std::uint8_t>(values[i]);
    return picture;
  }
  // One function, whose light may err by `light`, its codes by `steps`.
  static ErrorBound bound(double light, double steps) {
    return {Precision::single_, {{light, steps}}, {light, steps}};
  }

  CaptureFormat format_;
  RenderPlan plan_;
};

TEST_F(PictureErrors, OfLightByHand) {
  const LightErrors errors =
      light_errors(plan_, bound(0.02, 0), light({0.5, 0.5, 0.25, 1.5}), light({0.5, 0.51, 0.24, 1.53}));
  EXPECT_NEAR(errors.worst, 0.03, 1e-15);
  EXPECT_EQ(errors.worst_value, 3u);
  EXPECT_NEAR(errors.rms, std::sqrt((0.01 * 0.01 + 0.01 * 0.01 + 0.03 * 0.03) / 4), 1e-15);
  EXPECT_NEAR(errors.worst_8_bit_codes, 2.55, 1e-12);  // what is brighter than white is white
  EXPECT_NEAR(errors.worst_16_bit_codes, 655.35, 1e-10);
  EXPECT_NEAR(errors.share_of_bound, 1.5, 1e-12);
}

// Code 127 ends and 128 begins at 127.5.
TEST_F(PictureErrors, OfCodesByHand) {
  const Picture expected = light({127.4 / 255, 127.4 / 255, 127.4 / 255, 1.5});
  const StoredErrors right = stored_errors(plan_, bound(0, 0), expected, codes({127, 127, 127, 255}));
  EXPECT_EQ(right.values, 4u);
  EXPECT_EQ(right.differing, 0u);
  const Picture wrong = codes({128, 126, 127, 254});
  const StoredErrors narrow = stored_errors(plan_, bound(0, 0.2), expected, wrong);
  EXPECT_EQ(narrow.differing, 3u);
  EXPECT_EQ(narrow.explained, 1u);  // 128 is 0.1 away; 126 ends 0.9 before, and 254 half a code before white
  EXPECT_EQ(stored_errors(plan_, bound(0, 0.6), expected, wrong).explained, 2u);
  EXPECT_EQ(stored_errors(plan_, bound(0, 0.95), expected, wrong).explained, 3u);
}

TEST_F(PictureErrors, OfNoNumberExceedAnyBound) {
  const Picture expected = light({0.1, 0.2, 0.3, 0.4});
  const LightErrors wrong = light_errors(plan_, bound(INFINITY, 0), expected, light({0.1, 0.2, NAN, 0.4}));
  EXPECT_EQ(wrong.share_of_bound, INFINITY);
  EXPECT_EQ(wrong.bounded_error, INFINITY);
  EXPECT_EQ(wrong.worst_value, 2u);
  const LightErrors large =
      light_errors(plan_, bound(INFINITY, 0), expected, light({0.1, INFINITY, 0.3, 4e200}));
  EXPECT_EQ(large.share_of_bound, 1.0);
}

TEST_F(PictureErrors, OfFloatsAllowForTheirStep) {
  Picture floats(format_.shape, ValueType::light32, 0);
  const float next = std::nextafter(0.1f, 1.0f);
  std::ranges::copy(std::vector{0.1f, next, 0.11f, NAN}, floats.values<float>().begin());
  const StoredErrors errors = stored_errors(plan_, bound(1e-8, 0), light({0.1, 0.1, 0.1, 0.1}), floats);
  EXPECT_EQ(errors.differing, 3u);
  EXPECT_EQ(errors.explained, 1u);
}

// Beyond the largest float infinity is right where some light within the bound is stored so, and wrong elsewhere.
TEST_F(PictureErrors, OfFloatsBeyondTheLargest) {
  Picture floats(format_.shape, ValueType::light32, 0);
  std::ranges::copy(std::vector{INFINITY, -INFINITY, INFINITY, -INFINITY}, floats.values<float>().begin());
  const StoredErrors errors =
      stored_errors(plan_, bound(1e36, 0), light({3.4e38, -3.4e38, 3.3e38, 3.4e38}), floats);
  EXPECT_EQ(errors.differing, 4u);
  EXPECT_EQ(errors.explained, 2u);
}

TEST_F(PictureErrors, OfLightWhoseSquareIsNoNumber) {
  const LightErrors errors =
      light_errors(plan_, bound(1e201, 0), light({0, 0, 0, 0}), light({3e200, 0, 4e200, 0}));
  EXPECT_NEAR(errors.rms, 2.5e200, 1e188);
}

// What validate's exit status comes from: a picture is right only where every value is.
TEST_F(PictureErrors, OneWrongValueExceedsTheBound) {
  const Picture expected = light({0.1, 0.2, 0.3, 0.4});
  const StoredErrors stored = stored_errors(plan_, bound(1e-6, 1e-3), expected, codes({26, 51, 77, 102}));
  EXPECT_TRUE(is_within_bound(light_errors(plan_, bound(1e-6, 0), expected, expected), stored));
  for (const double value : {0.4 + 1.1e-6, -0.4, 0.0, std::nan(""), double{INFINITY}}) {
    const Picture wrong = light({0.1, 0.2, 0.3, value});
    const LightErrors errors = light_errors(plan_, bound(1e-6, 0), expected, wrong);
    EXPECT_FALSE(is_within_bound(errors, stored)) << value;
    EXPECT_EQ(errors.worst_value, 3u) << value;
  }
  const LightErrors right = light_errors(plan_, bound(1e-6, 0), expected, expected);
  EXPECT_FALSE(
      is_within_bound(right, stored_errors(plan_, bound(1e-6, 1e-3), expected, codes({26, 51, 78, 102}))));
}

// Where a function is zero nothing may differ.
TEST_F(PictureErrors, NothingIsAllowedWithoutABound) {
  const Picture expected = light({0, 0, 0, 0});
  EXPECT_EQ(light_errors(plan_, bound(0, 0), expected, expected).share_of_bound, 0.0);
  EXPECT_EQ(light_errors(plan_, bound(0, 0), expected, light({0, 0, 0, 1e-300})).share_of_bound, INFINITY);
}

// The reference's own codes never differ from its light, whatever the transfer function.
TEST_F(PictureErrors, TheReferenceAgreesWithItself) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const RandomCase random(seed);
    SCOPED_TRACE(random.text());
    MemoryCapture capture = random.encode();
    const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
    const Picture expected = ReferenceRenderer().render(plan, capture, {ValueType::light64, 0}).picture;
    for (const OutputFormat& output :
         {OutputFormat{ValueType::code8, 255}, OutputFormat{ValueType::code16, 65'535},
          OutputFormat{ValueType::light32, 0}, OutputFormat{ValueType::light64, 0}}) {
      const ErrorBound none = error_bound(plan, Precision::double_, output);
      const Picture picture = ReferenceRenderer().render(plan, capture, output).picture;
      EXPECT_EQ(stored_errors(plan, none, expected, picture).differing, 0u);
    }
  }
}

}  // namespace
}  // namespace nutik::test
