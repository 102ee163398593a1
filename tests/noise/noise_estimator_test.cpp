#include "noise/noise_estimator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "support/messages.hpp"
#include "support/noisy_scene.hpp"

namespace nutik::test {
namespace {

NoiseEstimate estimate(const NoisyCamera& camera, const Rasters& rasters) {
  NoiseEstimator estimator(camera.format);
  estimator.add_clip("clip", reader_of(rasters));
  return estimator.estimate();
}

// What is promised: sd within 3 % of the camera's own wherever noise is not cut off at black or white.
constexpr double kSyntheticBound = 0.03;
constexpr double kUnclipped = 4;  // standard deviations from black and white

// The worst share by which the estimated curve is off, over light from 0.001 to 1.
double worst_deviation(const NoisyCamera& camera, const NoiseEstimate& estimated) {
  double worst = 0;
  for (std::uint32_t channel = 0; channel < camera.format.shape.channels; ++channel) {
    for (double light = 0.001; light < 1; light *= 1.1) {
      const double reach = kUnclipped * std::sqrt(camera.read * camera.read + camera.shot * light);
      if (light < reach || light + reach > 1) continue;
      const NoisyCamera::Moments truth = camera.moments(light);
      const double deviation = estimated.noise.sd(channel, truth.mean) / truth.sd - 1;
      worst = std::max(worst, std::abs(deviation));
    }
  }
  return worst;
}

void expect_close(const NoisyCamera& camera, const NoiseEstimate& estimated, const std::string& what) {
  const double worst = worst_deviation(camera, estimated);
  std::printf("%s: sd within %.2f %%, misfit %.2f %%\n", what.c_str(), 100 * worst,
              100 * estimated.channels.front().misfit);
  EXPECT_LE(worst, kSyntheticBound) << what;
}

TEST(NoiseEstimator, FindsReadAndShotNoiseOfAnyCamera) {
  struct Case {
    std::uint32_t channels, white;
    Transfer transfer;
    double read, shot;
  };
  std::uint64_t seed = 1;
  for (const Case& each :
       {Case{3, 255, Transfer::srgb(), 0.004, 0.0004}, Case{3, 255, Transfer::bt709(), 0.001, 0.001},
        Case{1, 255, Transfer::linear(), 0.003, 0.0001}, Case{1, 255, Transfer::gamma(2.2), 0.002, 0.0002},
        Case{1, 4095, Transfer::linear(), 0.001, 0.0001}, Case{3, 65'535, Transfer::srgb(), 0.002, 0.0003},
        Case{1, 65'535, Transfer::linear(), 0.0001, 0.00002},
        Case{1, 65'535, Transfer::linear(), 0.004, 0}}) {
    const NoisyCamera camera = camera_of({240, 160, each.channels}, each.white, each.transfer, each.read, each.shot);
    const Rasters rasters = film(camera, 32, ++seed, still_wedge(camera, 0.0, 1.0));
    const NoiseEstimate estimated = estimate(camera, rasters);
    const std::string what =
        format("white {}, {}, read {}, shot {}", each.white, each.transfer.text(), each.read, each.shot);
    expect_close(camera, estimated, what);
    for (const ChannelNoise& channel : estimated.noise.channels) {
      EXPECT_EQ(channel.curve, NoiseCurve::sensor) << what;
      // Noise that is not there is lost in what is: 3 % of sd are 6 % of the variance of reading.
      const double bound = 0.06 * (each.shot + each.read * each.read);
      EXPECT_NEAR(channel.shot, each.shot, bound) << what;
    }
    EXPECT_EQ(estimated.sample_count, 32u);
  }
}

TEST(NoiseEstimator, AFewPicturesAreEnough) {
  const NoisyCamera camera = camera_of({240, 160, 1}, 4095, Transfer::linear());
  for (const std::uint64_t samples : {3u, 5u, 15u}) {
    const Rasters rasters = film(camera, samples, 100 + samples, still_wedge(camera, 0.0, 1.0));
    expect_close(camera, estimate(camera, rasters), format("{} samples", samples));
  }
}

TEST(NoiseEstimator, LeavesOutWhatMovesFlickersOrIsStuck) {
  const NoisyCamera camera = camera_of({240, 160, 3}, 255, Transfer::srgb());
  const Light wedge = still_wedge(camera, 0.0, 1.0);
  const Shape shape = camera.format.shape;
  const Light scene = [&](std::uint64_t value, std::uint64_t sample) {
    const std::uint64_t pixel = value / shape.channels;
    const auto x = static_cast<double>(pixel % shape.width), y = static_cast<double>(pixel / shape.width);
    if (pixel % 997 == 5) return pixel % 2 == 0 ? 1.0 : 0.0;              // stuck
    if (pixel % 1009 == 7) return (sample * pixel) % 3 == 0 ? 0.6 : 0.1;  // hot now and then
    const auto k = static_cast<double>(sample);
    const double across = x - 20 - 5 * k, down = y - 70;
    if (across * across + down * down < 900) return 0.35;          // a ball, a tenth of the picture's height
    const double lamp = 1 + 0.05 * std::sin(0.9 * k) + 0.002 * k;  // lamps flicker, and the sun comes out
    return wedge(value, sample) * lamp;
  };
  const NoiseEstimate estimated = estimate(camera, film(camera, 32, 7, scene));
  expect_close(camera, estimated, "a moving ball, flicker, hot pixels");
  for (const NoiseEstimate::Channel& channel : estimated.channels) {
    EXPECT_GT(channel.still_share, 0.75);
    EXPECT_LT(channel.still_share, 0.97);
    EXPECT_LT(channel.uneven, 0.25);  // some codes are those of the ball's edge
  }
}

// As in a liquid that is poured: all pixels vary alike, so that nearly all of them count as still; but what they vary
// by is common to neighbours.
TEST(NoiseEstimator, TellsWhatMovesFromNoise) {
  const NoisyCamera camera = camera_of({240, 160, 1}, 255, Transfer::srgb());
  const std::uint64_t width = camera.format.shape.width;
  const Light scene = [&](std::uint64_t value, std::uint64_t sample) {
    return 0.4 + 0.03 * waves(static_cast<double>(value % width), static_cast<double>(value / width),
                              static_cast<double>(sample), 7, 16);
  };
  const NoiseEstimate moving = estimate(camera, film(camera, 32, 3, scene));
  EXPECT_GT(moving.channels[0].still_share, 0.9);
  EXPECT_GT(moving.channels[0].shared, 0.5);
}

// A hand that holds the camera trembles: fine texture moves to and fro by a share of a pixel, so that neighbours have
// nothing in common, and pixels stray by what lies beside them.
TEST(NoiseEstimator, TellsTremblingFromNoise) {
  const NoisyCamera camera = camera_of({240, 160, 1}, 255, Transfer::srgb());
  Random random(8);
  std::vector<double> texture(camera.format.shape.value_count() + 1);
  for (double& light : texture) light = random.real(0.1, 0.6);
  for (const double pixels : {0.0, 0.1, 0.3}) {
    Normal hand(4);
    std::vector<double> moved(32);
    for (double& each : moved) each = pixels * hand.next();
    const Light scene = [&](std::uint64_t value, std::uint64_t sample) {
      return texture[value] + moved[sample] * (texture[value + 1] - texture[value]);
    };
    const NoiseEstimate::Channel measured = estimate(camera, film(camera, 32, 5, scene)).channels[0];
    EXPECT_LT(measured.shared, 0.25) << pixels;
    if (pixels == 0) {
      EXPECT_LT(measured.uneven, 0.1);
    } else {
      EXPECT_GT(measured.uneven, 0.9) << pixels;
    }
  }
}

// The covariance of n independent pairs strays by the variance / sqrt(n): here by less than 0.2 %, and shares of a
// scene with a moving ball by a little more.
TEST(NoiseEstimator, SharesNothingInNoise) {
  for (const std::uint32_t channels : {1u, 3u}) {
    const NoisyCamera camera = camera_of({240, 160, channels}, 255, Transfer::srgb());
    const NoiseEstimate still = estimate(camera, film(camera, 32, 9, still_wedge(camera, 0.0, 1.0)));
    for (const NoiseEstimate::Channel& channel : still.channels) {
      EXPECT_LT(std::fabs(channel.shared), 0.02);
      EXPECT_LT(channel.uneven, 0.1);
    }
  }
}

// What a camera interpolates of a mosaic is common to pixels up to two apart, and is noise all the same.
TEST(NoiseEstimator, SharesNothingInInterpolatedNoise) {
  const NoisyCamera camera = camera_of({240, 160, 1}, 65'535, Transfer::linear());
  Rasters rasters = film(camera, 32, 11, still_wedge(camera, 0.1, 0.9));
  interpolate_mosaic(rasters, camera.format.shape);
  const NoiseEstimate::Channel measured = estimate(camera, rasters).channels[0];
  EXPECT_LT(measured.shared, 0.05);
  EXPECT_LT(measured.uneven, 0.1);
}

TEST(NoiseEstimator, JoinsSeveralExposures) {
  const NoisyCamera camera = camera_of({240, 160, 1}, 65'535, Transfer::linear());
  NoiseEstimator estimator(camera.format);
  for (const double exposure : {0.02, 0.1, 0.5}) {
    estimator.add_clip("clip", reader_of(film(camera, 16, static_cast<std::uint64_t>(exposure * 1000),
                                              still_wedge(camera, 0.2 * exposure, exposure))));
  }
  const NoiseEstimate estimated = estimator.estimate();
  expect_close(camera, estimated, "three exposures");
  const auto& points = estimated.noise.channels.front().points;
  EXPECT_LT(points.front().code, 0.03 * 65'535);
  EXPECT_GT(points.back().code, 0.45 * 65'535);
  EXPECT_EQ(estimated.sample_count, 48u);
}

// No sensor's noise grows, shrinks and grows again with the light.
TEST(NoiseEstimator, FollowsThePointsWhereNoSensorDoes) {
  NoisyCamera camera = camera_of({240, 160, 1}, 65'535, Transfer::linear());
  camera.read = camera.shot = 0;
  const Light wedge = still_wedge(camera, 0.1, 0.9);
  const auto sd_at = [](double light) { return 0.003 + 0.002 * std::sin(12 * light); };
  Normal normal(3);
  const Rasters rasters = film(camera, 32, 3, [&](std::uint64_t value, std::uint64_t sample) {
    const double light = wedge(value, sample);
    return light + sd_at(light) * normal.next();
  });
  const NoiseEstimate estimated = estimate(camera, rasters);
  EXPECT_EQ(estimated.noise.channels.front().curve, NoiseCurve::points);
  for (double light = 0.12; light < 0.88; light += 0.01) {
    EXPECT_NEAR(estimated.noise.sd(0, light * 65'535) / 65'535 / sd_at(light), 1, 0.05) << light;
  }
}

TEST(NoiseEstimator, RoundingIsTheLeastNoise) {
  NoisyCamera camera = camera_of({240, 160, 3}, 255, Transfer::srgb());
  camera.read = camera.shot = 0;
  const NoiseEstimate estimated = estimate(camera, film(camera, 16, 1, still_wedge(camera, 0.1, 0.9)));
  for (std::uint32_t code = 0; code <= 255; ++code) {
    EXPECT_NEAR(estimated.noise.sd(0, code), std::sqrt(1.0 / 12), 1e-6);
  }
}

TEST(NoiseEstimator, SaysWhyItCannot) {
  const NoisyCamera camera = camera_of({240, 160, 1}, 255, Transfer::srgb());
  const auto message = [&](const Rasters& rasters) {
    return message_of<InputError>([&] { return estimate(camera, rasters); });
  };
  const Light wedge = still_wedge(camera, 0.1, 0.9);
  EXPECT_EQ(message(film(camera, 2, 1, wedge)),
            "clip: 2 pictures of a still scene; noise is measured on 3 or more");
  EXPECT_EQ(message({}), "clip: 0 pictures of a still scene; noise is measured on 3 or more");
  EXPECT_EQ(message(film(camera, 8, 1, [](std::uint64_t, std::uint64_t) { return 5.0; })),
            "all pixels are black or white, where noise is cut off: film a scene with greys");
}

}  // namespace
}  // namespace nutik::test
