#include "scene/clean_plate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/noisy_scene.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

constexpr std::uint32_t kWidth = 53, kHeight = 29;  // no whole tiles

CaptureFormat format(std::uint32_t channels, std::uint32_t code_bytes, std::uint32_t white) {
  return {.shape = {kWidth, kHeight, channels}, .code_bytes = code_bytes, .white_code = white};
}

// What the scene is without its subject, in light.
double empty_light(const CaptureFormat& capture, std::uint64_t value) {
  const auto x = static_cast<double>(value / capture.shape.channels % kWidth);
  const auto channel = static_cast<double>(value % capture.shape.channels);
  return 0.08 + 0.6 * x / kWidth + 0.05 * channel;
}

// A subject of 8 x 9 pixels that goes from left to right over 60 samples, resting at x = 24 for 40 of 100.
bool is_subject(const CaptureFormat& capture, std::uint64_t value, std::uint64_t sample) {
  const auto pixel = static_cast<std::int64_t>(value / capture.shape.channels);
  const std::int64_t x = pixel % kWidth, y = pixel / kWidth;
  const auto k = static_cast<std::int64_t>(sample);
  const std::int64_t left = k < 30 ? k * 24 / 30 : k < 70 ? 24 : 24 + (k - 70);
  return x >= left && x < left + 8 && y >= 10 && y < 19;
}

double subject_light(const CaptureFormat& capture, std::uint64_t value) {
  return value % capture.shape.channels == 0 ? 0.9 : 0.02;
}

double code_of(const CaptureFormat& capture, double light) {
  return capture.transfer.fraction_of(light) * capture.white_code;
}

// The root of the mean square by which a plate differs from the empty scene, in codes.
double rms_codes(const CaptureFormat& capture, const Plate& plate) {
  double sum = 0;
  const auto light = plate.light.values<double>();
  for (std::uint64_t i = 0; i < light.size(); ++i) {
    sum += std::pow(code_of(capture, light[i]) - code_of(capture, empty_light(capture, i)), 2);
  }
  return std::sqrt(sum / static_cast<double>(light.size()));
}

class Plates : public testing::TestWithParam<CaptureFormat> {};

TEST_P(Plates, ShowNoSubjectThatRestsForTwoFifthsOfTheTime) {
  NoisyCamera camera;
  camera.format = GetParam();
  const Rasters rasters = film(camera, 100, 7, [&](std::uint64_t value, std::uint64_t sample) {
    return is_subject(camera.format, value, sample) ? subject_light(camera.format, value)
                                                    : empty_light(camera.format, value);
  });
  MemoryCapture capture(camera.format, Timeline::constant({100, 1}, Timeline::kFullShutter, 100), rasters,
                        37);
  CameraNoise noise;
  noise.white_code = camera.format.white_code;
  noise.channels.assign(camera.format.shape.channels, {NoiseCurve::sensor, camera.read, camera.shot, {}});
  const Plate plate = make_plate(capture, CodeBand::of_noise(camera.format, noise), 1 << 30);
  EXPECT_LT(rms_codes(camera.format, plate), camera.format.white_code / 255.0);
  EXPECT_EQ(plate.uncertain.pixel_count(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Codes, Plates,
                         testing::Values(format(1, 1, 255), format(3, 1, 255), format(3, 2, 4095)));

// Codes of one pixel, sample by sample, as a capture of one grey pixel; `starts_ns` in milliseconds.
MemoryCapture one_pixel(const std::vector<std::uint8_t>& codes, const std::vector<std::int64_t>& starts_ms) {
  CaptureFormat capture = format(1, 1, 255);
  capture.shape = {1, 1, 1};
  Rasters rasters;
  std::vector<std::int64_t> starts_ns;
  for (std::size_t k = 0; k < codes.size(); ++k) {
    rasters.push_back({std::byte{codes[k]}});
    starts_ns.push_back(starts_ms[k] * 1'000'000);
  }
  return {capture, Timeline::irregular(starts_ns, Timeline::kFullShutter), rasters, 3};
}

double code_of_pixel(MemoryCapture& capture, std::uint32_t by_codes) {
  const Plate plate = make_plate(capture, CodeBand::of_codes(capture.format(), by_codes), 1 << 20);
  return code_of(capture.format(), plate.light.values<double>()[0]);
}

TEST(Plate, CountsTimeAndNotSamples) {
  MemoryCapture capture = one_pixel({200, 200, 200, 200, 40, 90, 90}, {0, 10, 20, 30, 40, 140, 150});
  EXPECT_NEAR(code_of_pixel(capture, 0), 40, 1e-9) << "held once, for 100 ms, the other four times for 10 ms";
}

TEST(Plate, TakesCodesForOneLightThatDifferByNoMoreThanStated) {
  MemoryCapture capture = one_pixel({10, 14, 12, 90, 90, 30}, {0, 10, 20, 30, 40, 50});
  EXPECT_NEAR(code_of_pixel(capture, 0), 90, 1e-9);
  const double together = code_of_pixel(capture, 2);
  EXPECT_GT(together, 11.9);
  EXPECT_LT(together, 12.2) << "the mean light of 10, 14 and 12";
}

// Every other sample: three of 40 and one of 200, which the others are all.
TEST(Plate, OfFewSamplesTakesWhatTheyHold) {
  MemoryCapture capture = one_pixel({40, 200, 40, 200, 40, 200, 200, 200}, {0, 10, 20, 30, 40, 50, 60, 70});
  const CodeBand band = CodeBand::of_codes(capture.format(), 5);
  const auto code_of_few = [&](std::uint64_t max_samples) {
    const Plate plate = make_plate(capture, band, 1 << 20, max_samples);
    return code_of(capture.format(), plate.light.values<double>()[0]);
  };
  EXPECT_NEAR(code_of_few(8), 200, 1e-9);
  EXPECT_NEAR(code_of_few(4), 40, 1e-9);
  EXPECT_NEAR(code_of_few(100), 200, 1e-9);
}

TEST(Plate, IsUnsureOfPixelsThatNothingHoldsForHalfOfTheTime) {
  MemoryCapture unsure = one_pixel({10, 10, 90, 90, 170}, {0, 10, 20, 30, 40});
  const CodeBand band = CodeBand::of_codes(unsure.format(), 5);
  EXPECT_EQ(make_plate(unsure, band, 1 << 20).uncertain.pixel_count(), 1u);
  MemoryCapture sure = one_pixel({10, 10, 90, 170}, {0, 10, 20, 30});
  EXPECT_EQ(make_plate(sure, band, 1 << 20).uncertain.pixel_count(), 0u);
}

TEST(Plate, LooksAtTheColoursOfOneTimeTogether) {
  // Most often green is 100, and red 200: never at once. Half of the time the pixel is (50, 100, 50).
  CaptureFormat capture = format(3, 1, 255);
  capture.shape = {1, 1, 3};
  Rasters rasters;
  for (const auto& [red, green] :
       {std::pair(50, 100), {50, 100}, {50, 100}, {200, 20}, {200, 60}, {200, 180}}) {
    rasters.push_back({std::byte(red), std::byte(green), std::byte(50)});
  }
  MemoryCapture held(capture, Timeline::constant({100, 1}, Timeline::kFullShutter, 6), rasters, 64);
  const Plate plate = make_plate(held, CodeBand::of_codes(capture, 3), 1 << 20);
  EXPECT_NEAR(code_of(capture, plate.light.values<double>()[0]), 50, 1e-9);
  EXPECT_NEAR(code_of(capture, plate.light.values<double>()[1]), 100, 1e-9);
}

// A scene of 80 that three people stand in, one after another, each of whom hides the same place: two have the
// same dark legs, and no two the same coat. These legs are held for 45 % of the time, and what is behind them for 40 %.
// At a knee all three are dark: that is held for 60 %.
TEST(Plate, ShowsOfAnUncertainPlaceWhatItHoldsLongestAsAWhole) {
  constexpr std::uint32_t kSide = 48;
  CaptureFormat capture = format(1, 1, 255);
  capture.shape = {kSide, kSide, 1};
  Rasters rasters;
  for (int k = 0; k < 100; ++k) {
    const bool is_first = k >= 10 && k < 35, is_second = k >= 50 && k < 70, is_third = k >= 80 && k < 95;
    std::vector<std::byte> raster(std::size_t{kSide} * kSide, std::byte{80});
    for (std::uint32_t y = 8; y < 40 && (is_first || is_second || is_third); ++y) {
      const int legs = is_third ? 40 : 10, coat = is_first ? 120 : is_second ? 200 : 160;
      for (std::uint32_t x = 16; x < 32; ++x) {
        const bool is_knee = x == 23 && y == 30;
        raster[y * kSide + x] = std::byte(y < 24 ? coat : is_knee ? 10 : legs);
      }
    }
    rasters.push_back(std::move(raster));
  }
  MemoryCapture held(capture, Timeline::constant({100, 1}, Timeline::kFullShutter, 100), rasters, 37);
  const Plate plate = make_plate(held, CodeBand::of_codes(capture, 4), 1 << 24);
  EXPECT_EQ(plate.uncertain.pixel_count(), 32u * 16u);
  for (const double light : plate.light.values<double>()) ASSERT_NEAR(code_of(capture, light), 80, 1e-9);
}

TEST(Plate, SaysTheLeastMemoryThatWorks) {
  MemoryCapture capture = one_pixel({1, 2}, {0, 10});
  const CodeBand band = CodeBand::of_codes(capture.format(), 0);
  EXPECT_THROW(static_cast<void>(make_plate(capture, band, 9)), MemoryTooLittle);
}

}  // namespace
}  // namespace nutik::test
