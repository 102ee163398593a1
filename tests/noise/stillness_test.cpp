#include "noise/stillness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "capture/format.hpp"
#include "noise/noise_estimator.hpp"
#include "support/noisy_scene.hpp"

namespace nutik::test {
namespace {

NoisyCamera grey_camera() { return camera_of({96, 64, 1}, 255, Transfer::srgb()); }
NoisyCamera deep_camera() { return camera_of({96, 64, 1}, 4095, Transfer::linear(), 0.002, 0.0001); }

// With the noise that is measured on the clip itself, as where a clip is encoded.
Stillness judged(const NoisyCamera& camera, const Rasters& rasters) {
  NoiseEstimator estimator(camera.format);
  StillnessWatch watch(camera.format, rasters.size());
  estimator.add_clip("clip", [&, next = std::size_t{0}](std::span<std::byte> raster) mutable {
    if (next == rasters.size()) return false;
    std::ranges::copy(rasters[next], raster.begin());
    watch.add(rasters[next++]);
    return true;
  });
  return watch.judge(estimator.estimate().noise);
}

Stillness judged(const NoisyCamera& camera, std::uint64_t samples, std::uint64_t seed, const Light& light) {
  return judged(camera, film(camera, samples, seed, light));
}

bool stands_still(const Stillness& found) { return found.stray <= found.limit; }

// Waves of 12 to 40 pixels in several directions, between about -1 and 1: as they stand, or as they run at time k.
double ripples(double x, double y, double k = 0) { return waves(x, y, k, 8, 12) / 4; }

struct Place {
  double x, y;
};

// Light that depends on where a pixel lies, and on the sample.
template <typename OfPlace>
Light scene(const NoisyCamera& camera, OfPlace of_place) {
  return [shape = camera.format.shape, of_place](std::uint64_t value, std::uint64_t sample) {
    const std::uint64_t pixel = value / shape.channels;
    const Place place{static_cast<double>(pixel % shape.width), static_cast<double>(pixel / shape.width)};
    return of_place(place, static_cast<double>(sample));
  };
}

double textured(Place at) { return 0.3 + 0.1 * ripples(at.x, at.y) + 0.001 * at.x; }

Light panned(const NoisyCamera& camera, double pixels_a_picture) {
  return scene(camera, [=](Place at, double k) { return textured({at.x + pixels_a_picture * k, at.y}); });
}

TEST(Stillness, IsSeenInEveryCamera) {
  struct Case {
    std::uint32_t channels, white;
    Transfer transfer;
    double read, shot;
  };
  std::uint64_t seed = 40;
  double nearest = 0;
  for (const Case& each :
       {Case{3, 255, Transfer::srgb(), 0.004, 0.0004}, Case{1, 255, Transfer::linear(), 0.0005, 0.00001},
        Case{1, 255, Transfer::srgb(), 0, 0}, Case{1, 4095, Transfer::linear(), 0.001, 0.0001},
        Case{3, 65'535, Transfer::bt709(), 0.002, 0.0003}}) {
    const NoisyCamera camera = camera_of({96, 64, each.channels}, each.white, each.transfer, each.read, each.shot);
    for (const std::uint64_t samples : {3U, 4U, 5U, 17U, 64U, 100U}) {
      const Light still = scene(camera, [](Place at, double) { return textured(at); });
      const Stillness found = judged(camera, samples, ++seed, still);
      const std::string what = format("white {}, {} samples, seed {}", each.white, samples, seed);
      nearest = std::max({nearest, found.stray / found.limit, found.max_stray / found.max_limit});
      EXPECT_LE(found.stray, found.limit) << what;
      EXPECT_LE(found.max_stray, found.max_limit) << what;
      EXPECT_EQ(found.stray_share, 0) << what;
    }
  }
  std::printf("still scenes stray by up to %.2f of the limit, of the picture or a region\n", nearest);
}

TEST(Stillness, IsSeenInPicturesOfAnySize) {
  NoisyCamera camera = grey_camera();
  for (const Shape shape : {Shape{1, 1, 1}, Shape{9, 7, 1}, Shape{1, 300, 3}, Shape{300, 250, 1}}) {
    camera.format.shape = shape;
    const Light still = scene(camera, [](Place at, double) { return 0.3 + 0.0005 * (at.x + at.y); });
    const Rasters rasters = film(camera, 20, 3, still);
    StillnessWatch watch(camera.format, 20);
    for (const auto& raster : rasters) watch.add(raster);
    CameraNoise noise;
    noise.white_code = 255;
    const double sd = camera.moments(0.3).sd;
    noise.channels.assign(shape.channels, {NoiseCurve::points, 0, 0, {{100, sd, 1}}});
    EXPECT_TRUE(stands_still(watch.judge(noise))) << shape.width << " x " << shape.height;
  }
}

// What a camera interpolates of a mosaic is common to neighbours, and noise all the same.
TEST(Stillness, IsSeenInInterpolatedNoise) {
  const NoisyCamera camera = deep_camera();
  Rasters rasters = film(camera, 64, 11, scene(camera, [](Place at, double) { return textured(at); }));
  interpolate_mosaic(rasters, camera.format.shape);
  EXPECT_TRUE(stands_still(judged(camera, rasters)));
}

// A ball of a twelfth of the picture's width that crosses it, and lamps that blink: each pixel is seen to change.
TEST(Stillness, OfTheBackgroundIsEnough) {
  for (const NoisyCamera& camera : {grey_camera(), deep_camera()}) {
    const Stillness found = judged(camera, 128, 5, scene(camera, [](Place at, double k) {
                                     if (std::hypot(at.x - 0.75 * k, at.y - 20) < 8) return 0.8;
                                     if (at.x < 4 && at.y > 60) return std::fmod(k, 5) == 0 ? 0.9 : 0.1;
                                     return textured(at);
                                   }));
    EXPECT_TRUE(stands_still(found)) << found.stray;
  }
}

TEST(Stillness, IsMissedWhereTheCameraPans) {
  for (const NoisyCamera& camera : {grey_camera(), deep_camera()}) {
    for (const double pixels : {0.05, 0.1, 0.3}) {
      const Stillness found = judged(camera, 64, 5, panned(camera, pixels));
      EXPECT_GT(found.stray, found.limit) << pixels;
      EXPECT_FALSE(found.is_brightness) << pixels;
      EXPECT_GT(found.stray_share, 0.5) << pixels;
    }
  }
}

// Where noise is the same at all light, the result is what was put in, in standard deviations: a share of the frames'
// deviations at one brightness, or a drift's divided by the root of 12. Noise lets it stray by less than 0.01.
TEST(Stillness, IsMissedByAsMuchAsBrightnessStrays) {
  NoisyCamera camera = deep_camera();
  camera.shot = 0;
  const double sd = std::hypot(camera.read, 1 / std::sqrt(12.0) / 4095);
  for (const double share : {0.3, 0.5}) {
    const Stillness flicker = judged(camera, 64, 5, scene(camera, [&](Place at, double k) {
                                       return textured(at) + share * sd * std::numbers::sqrt2 *
                                                                 std::sin(2 * std::numbers::pi * 5 * k / 64);
                                     }));
    EXPECT_NEAR(flicker.stray, share, 0.02);
    EXPECT_GT(flicker.stray, flicker.limit);
    EXPECT_TRUE(flicker.is_brightness);
  }
  const Stillness drift = judged(camera, 64, 6, scene(camera, [&](Place at, double k) {
                                   return textured(at) + 0.3 * sd * std::sqrt(12.0) * k / 64;
                                 }));
  EXPECT_NEAR(drift.stray, 0.3, 0.02);
  EXPECT_GT(drift.stray, drift.limit);
  EXPECT_TRUE(drift.is_brightness);
  const Stillness little =
      judged(camera, 64, 7,
             scene(camera, [&](Place at, double k) { return textured(at) + 0.1 * sd * std::sin(0.7 * k); }));
  EXPECT_TRUE(stands_still(little));
}

// A liquid is poured in an eighth of the picture, while the second half of the pictures is taken.
TEST(Stillness, IsMissedInAnEighth) {
  for (const NoisyCamera& camera : {grey_camera(), deep_camera()}) {
    for (const double strays : {2.0, 5.0}) {  // standard deviations of the noise
      const Light light = scene(camera, [&](Place at, double k) {
        const double still = textured(at);
        if (at.x < 48 || at.x >= 60 || k < 64) return still;
        return still +
               strays * std::sqrt(camera.read * camera.read + camera.shot * still) * ripples(at.x, at.y, k);
      });
      const Stillness found = judged(camera, 128, 5, light);
      EXPECT_GT(found.max_stray, found.max_limit) << strays;
      EXPECT_FALSE(found.is_brightness);
      EXPECT_GE(found.region.x, 36U);
      EXPECT_LE(found.region.x + found.region.width, 72U);
      EXPECT_EQ(found.first_sample, 64U);
      EXPECT_EQ(found.last_sample, 127U);
      EXPECT_NEAR(found.stray_share, 0.15, 0.1);
    }
  }
}

}  // namespace
}  // namespace nutik::test
