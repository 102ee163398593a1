#include "imev/expected_values.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "imev/capture_source.hpp"
#include "noise/noise_estimator.hpp"
#include "support/messages.hpp"
#include "support/noisy_scene.hpp"
#include "support/payloads.hpp"
#include "support/raster_stream.hpp"

namespace nutik::test {
namespace {

// Grey noise of a constant standard deviation in codes.
CaptureFormat flat_noise(Shape shape, std::uint32_t white, double sd) {
  CaptureFormat capture{
      .shape = shape, .code_bytes = white > 255 ? 2u : 1u, .white_code = white, .transfer = Transfer::linear()};
  const ChannelNoise channel{NoiseCurve::points, 0, 0, {{0, sd, 1}}};
  capture.noise.camera =
      CameraNoise{white, capture.transfer, std::vector<ChannelNoise>(shape.channels, channel)};
  return capture;
}

MemoryCapture encode(const CaptureFormat& source, const Rasters& rasters, std::uint32_t block_samples) {
  return {source, Timeline::constant({100, 1}, Timeline::kFullShutter, rasters.size()), rasters,
          block_samples};
}

// What is held at every sample.
Rasters held_by(const MemoryCapture& capture) {
  Rasters held;
  for (std::uint64_t block = 0; block < capture.block_count(); ++block) {
    for (std::uint32_t k = 0; k < capture.block_extent(block).sample_count; ++k) {
      held.emplace_back(capture.format().sample_bytes());
      capture.view(block).read_sample(k, held.back());
    }
  }
  return held;
}

std::uint64_t record_count(const MemoryCapture& capture) {
  std::uint64_t records = 0;
  std::vector<ChangeRecord> history;
  const Shape& shape = capture.format().shape;
  const TileGrid grid(shape);
  for (std::uint64_t block = 0; block < capture.block_count(); ++block) {
    const BlockView view = capture.view(block);
    for (std::uint32_t y = 0; y < shape.height; ++y) {
      for (std::uint32_t x = 0; x < shape.width; ++x) {
        view.read_history(grid.tile_of(x, y), TileGrid::lane_of(x, y), history);
        records += history.size() - 1;
      }
    }
  }
  return records;
}

// The codes that one pixel of a grey capture holds, its samples being `codes`.
std::vector<double> held_codes(const CaptureFormat& source, const std::vector<std::uint32_t>& codes) {
  Rasters rasters;
  for (const std::uint32_t code : codes) {
    rasters.emplace_back(source.sample_bytes());
    set_code(source, rasters.back(), 0, code);
  }
  const MemoryCapture capture = encode(source, rasters, static_cast<std::uint32_t>(codes.size()));
  std::vector<double> held;
  for (const auto& raster : held_by(capture)) {
    held.push_back(static_cast<double>(code_at(capture.format(), raster, 0)) / held_scale(source));
  }
  return held;
}

TEST(HeldFormat, HasRoomForMeans) {
  const auto white = [](std::uint32_t source_white) {
    const CaptureFormat held = held_format(flat_noise({1, 1, 1}, source_white, 1));
    EXPECT_EQ(held.code_bytes, 2u);
    EXPECT_EQ(held, held_format(held));
    return held.white_code;
  };
  EXPECT_EQ(white(255), 65'535u);      // 257
  EXPECT_EQ(white(1023), 64 * 1023u);  // all bits that there are
  EXPECT_EQ(white(4095), 16 * 4095u);
  EXPECT_EQ(white(40'000), 40'000u);
  CaptureFormat lossless;
  EXPECT_EQ(held_format(lossless), lossless);
}

TEST(ExpectedValues, EverySampleIsWithinTheBandOfWhatIsHeld) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    CaptureFormat source = random_format(random);
    source.noise.tolerance = 0;
    source.noise.sigmas = random.real(0.5, 6);
    CameraNoise camera{source.white_code, source.transfer, {}};
    for (std::uint32_t c = 0; c < source.shape.channels; ++c) {
      ChannelNoise channel{random.chance(0.5) ? NoiseCurve::sensor : NoiseCurve::points,
                           random.real(0, 0.02),
                           random.real(0, 0.001),
                           {}};
      channel.points = {{source.white_code * 0.2, source.white_code * random.real(0.001, 0.05), 9},
                        {source.white_code * 0.7, source.white_code * random.real(0.001, 0.05), 9}};
      camera.channels.push_back(channel);
    }
    source.noise.camera = camera;
    const Rasters rasters = random_rasters(random, source, static_cast<std::uint64_t>(random.whole(1, 90)));
    const MemoryCapture capture = encode(source, rasters, static_cast<std::uint32_t>(random.whole(1, 70)));
    const Rasters held = held_by(capture);
    const std::uint32_t scale = held_scale(source);
    for (std::size_t k = 0; k < rasters.size(); ++k) {
      for (std::uint64_t value = 0; value < source.shape.value_count(); ++value) {
        const double code = static_cast<double>(code_at(capture.format(), held[k], value)) / scale;
        const auto channel = static_cast<std::uint32_t>(value % source.shape.channels);
        const double band = source.noise.sigmas * camera.sd(channel, code);
        ASSERT_LE(std::abs(code - code_at(source, rasters[k], value)), band * (1 + 1e-6))
            << "seed " << seed << ", sample " << k << ", value " << value;
      }
    }
  }
}

TEST(ExpectedValues, HoldTheMeanInLight) {
  CaptureFormat source = flat_noise({1, 1, 1}, 255, 4);
  source.transfer = Transfer::srgb();
  source.noise.camera->transfer = source.transfer;
  const std::vector<double> held = held_codes(source, {96, 104, 100, 103});
  const auto light = [&](double code) { return source.transfer.light_of(code / 255); };
  const double mean = (light(96) + light(104) + light(100) + light(103)) / 4;
  for (const double code : held) EXPECT_NEAR(light(code), mean, (light(101) - light(100)) / 257);
  EXPECT_GT(held[0], (96 + 104 + 100 + 103) / 4.0 + 1.0 / 257);  // not the mean of the codes
}

TEST(ExpectedValues, StillCodesAreHeldExactly) {
  const CaptureFormat source = flat_noise({1, 1, 1}, 255, 2);
  for (const std::uint32_t code : {0u, 1u, 77u, 254u, 255u}) {
    for (const double held : held_codes(source, std::vector<std::uint32_t>(9, code))) EXPECT_EQ(held, code);
  }
}

// Each in codes; the noise is 2, the band 6.
TEST(ExpectedValues, AnEdgeIsHeldWhereItIs) {
  const CaptureFormat source = flat_noise({1, 1, 1}, 255, 2);
  for (std::uint32_t edge = 1; edge < 20; ++edge) {
    std::vector<std::uint32_t> codes(20, 100);
    std::fill(codes.begin() + edge, codes.end(), 110);  // five standard deviations
    const std::vector<double> held = held_codes(source, codes);
    for (std::uint32_t k = 0; k < 20; ++k)
      EXPECT_EQ(held[k], codes[k]) << "edge at " << edge << ", sample " << k;
  }
}

TEST(ExpectedValues, ASparkIsHeldAndTheLevelGoesOn) {
  const CaptureFormat source = flat_noise({1, 1, 1}, 255, 2);
  for (const std::uint32_t spark : {108u, 120u, 250u}) {
    for (const std::uint32_t length : {1u, 2u}) {
      std::vector<std::uint32_t> codes(32);
      for (std::uint32_t k = 0; k < 32; ++k) codes[k] = 99 + k % 3;
      for (std::uint32_t k = 13; k < 13 + length; ++k) codes[k] = spark;
      const std::vector<double> held = held_codes(source, codes);
      EXPECT_EQ(held[13], spark);
      EXPECT_EQ(held[12], held[13 + length]);  // one level, with all its samples
      EXPECT_EQ(held[0], held[31]);
      EXPECT_NEAR(held[0], 100, 0.1);
    }
  }
}

// 40 codes over 64 samples, 20 standard deviations: a band alone would let them stray by 6 codes.
TEST(ExpectedValues, ARampIsFollowedByStepsWithinTheNoise) {
  const CaptureFormat source = flat_noise({1, 1, 1}, 4095, 2);
  std::vector<std::uint32_t> codes(64);
  for (std::uint32_t k = 0; k < 64; ++k) codes[k] = 1000 + k * 40 / 63;
  const std::vector<double> held = held_codes(source, codes);
  double worst = 0;
  for (std::uint32_t k = 0; k < 64; ++k) worst = std::max(worst, std::abs(held[k] - codes[k]));
  EXPECT_LE(worst, 2 * 2.0);
  EXPECT_GT(worst, 0.5);  // steps all the same
}

TEST(ExpectedValues, RefusesTheNoiseOfOtherCodes) {
  const auto message = [](const CaptureFormat& source) {
    return message_of<UsageError>([&] { BlockBuilder(source, 4, TilePolicy::automatic); });
  };
  CaptureFormat source = flat_noise({8, 8, 1}, 255, 2);
  EXPECT_EQ(message(source), "");
  source.white_code = 200;
  EXPECT_EQ(
      message(source),
      "the noise was measured with white code 255 and the clip's is 200; measure it on a clip of the same "
      "kind, or on the clip itself");
  source.white_code = 255;
  source.shape.channels = 3;
  EXPECT_EQ(
      message(source),
      "the noise was measured on 1 channel and the clip has 3; measure it on a clip of the same kind, or on "
      "the clip itself");
}

// Blocks of a stream that is left early hold what they hold in a file of the whole capture.
TEST(ExpectedValues, AStreamHoldsWhatAFileHolds) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const CaptureFormat source = flat_noise({11, 9, 3}, 255, 3);
    const auto samples = static_cast<std::uint64_t>(random.whole(2, 60));
    const Rasters rasters = random_rasters(random, source, samples);
    const auto block_samples = static_cast<std::uint32_t>(random.whole(1, 20));
    const MemoryCapture file = encode(source, rasters, block_samples);
    const auto first = static_cast<std::uint64_t>(random.whole(0, static_cast<std::int64_t>(samples) - 1));
    const auto last = static_cast<std::uint64_t>(
        random.whole(static_cast<std::int64_t>(first) + 1, static_cast<std::int64_t>(samples)));
    StreamingCapture stream(source, file.timeline(), {first, last}, block_samples, TilePolicy::automatic,
                            RasterStream(rasters));
    EXPECT_EQ(stream.format(), file.format());
    for (std::uint64_t block = first / block_samples; block < stream.block_count(); ++block) {
      ASSERT_EQ(stream.block_extent(block), file.block_extent(block)) << seed;
      const auto payload = payload_of(stream, block);
      const auto expected = file.view(block).payload();
      ASSERT_TRUE(std::ranges::equal(payload, expected)) << "seed " << seed << ", block " << block;
    }
  }
}

// Root of the mean square by which exposures of samples [first, last) differ from the light that was there.
double exposure_error(const CaptureFormat& format, const Rasters& rasters, const Light& light,
                      std::uint64_t first, std::uint64_t last) {
  const std::vector<double> light_of = format.transfer.light_of_codes(format.white_code);
  double squares = 0;
  for (std::uint64_t value = 0; value < format.shape.value_count(); ++value) {
    double error = 0;
    for (std::uint64_t k = first; k < last; ++k) {
      error += light_of[code_at(format, rasters[k], value)] - light(value, k);
    }
    squares += std::pow(error / static_cast<double>(last - first), 2);
  }
  return std::sqrt(squares / static_cast<double>(format.shape.value_count()));
}

struct Camera {
  const char* name;
  std::uint32_t channels, white;
  Transfer transfer;
  double read, shot;

  [[nodiscard]] NoisyCamera filming(Shape shape) const {
    return camera_of({shape.width, shape.height, channels}, white, transfer, read, shot);
  }
};

std::vector<Camera> cameras() {
  return {{"8 bits, srgb, colour", 3, 255, Transfer::srgb(), 0.004, 0.0004},
          {"8 bits, bt709, colour, little noise", 3, 255, Transfer::bt709(), 0.001, 0.0001},
          {"12 bits, linear, grey", 1, 4095, Transfer::linear(), 0.002, 0.0003},
          {"16 bits, linear, colour", 3, 65'535, Transfer::linear(), 0.004, 0.0002}};
}

CameraNoise estimated_noise(const CaptureFormat& format, const Rasters& rasters) {
  NoiseEstimator estimator(format);
  estimator.add_clip("clip", reader_of(rasters));
  return estimator.estimate().noise;
}

TEST(ExpectedValues, AStillSceneComesOutLessNoisyThanAnyFrame) {
  for (const Camera& each : cameras()) {
    const NoisyCamera camera = each.filming({96, 64, 3});
    const Light light = still_wedge(camera, 0.02, 0.8);
    const Rasters rasters = film(camera, 256, 11, light);
    CaptureFormat source = camera.format;
    source.noise.camera = estimated_noise(source, rasters);
    const MemoryCapture capture = encode(source, rasters, 64);
    const Rasters held = held_by(capture);

    const double share = static_cast<double>(record_count(capture)) /
                         static_cast<double>(rasters.size() * source.shape.pixel_count());
    double one_sample = 0, one_frame = 0;  // the mean over samples all along the clip
    for (std::uint64_t k = 5; k < 256; k += 25) {
      one_sample += exposure_error(capture.format(), held, light, k, k + 1);
      one_frame += exposure_error(source, rasters, light, k, k + 1);
    }
    EXPECT_LE(share, 0.02) << each.name;
    EXPECT_LE(one_sample, one_frame / 2) << each.name;
    double worst_long = 0;
    for (const std::uint64_t first : {0u, 64u, 17u, 100u}) {  // on blocks and across them
      const double ratio = exposure_error(capture.format(), held, light, first, first + 64) /
                           exposure_error(source, rasters, light, first, first + 64);
      EXPECT_LE(ratio, 1.1) << each.name << ", from sample " << first;
      worst_long = std::max(worst_long, ratio);
    }
    std::printf(
        "%s: records at %.2f %% of samples; error of one sample %.3f, of 64 at most %.3f times a frame's\n",
        each.name, 100 * share, one_sample / one_frame, worst_long);
  }
}

// A bright bar crosses a still scene, four pixels a sample.
TEST(ExpectedValues, AMovingObjectIsNeitherSmearedNorDropped) {
  for (const Camera& each : cameras()) {
    const NoisyCamera camera = each.filming({160, 48, 3});
    const Light still = still_wedge(camera, 0.02, 0.3);
    const auto is_object = [&](std::uint64_t value, std::uint64_t sample) {
      const std::uint64_t x = value / camera.format.shape.channels % camera.format.shape.width;
      return x >= 2 * sample && x < 2 * sample + 12;
    };
    const Light light = [&](std::uint64_t value, std::uint64_t sample) {
      return is_object(value, sample) ? 0.6 : still(value, sample);
    };
    const Rasters rasters = film(camera, 64, 5, light);
    CaptureFormat source = camera.format;
    source.noise.camera = estimated_noise(source, film(camera, 32, 6, still));
    const MemoryCapture capture = encode(source, rasters, 64);
    const Rasters held = held_by(capture);
    const std::vector<double> light_of =
        capture.format().transfer.light_of_codes(capture.format().white_code);

    // Every sample is within the band of what is held (above), and it is within 6 standard deviations of the
    // light in all of these: so what is held is within both of the light. The object stands out by far more.
    double worst = 0, squares = 0;
    std::uint64_t count = 0;
    for (std::uint64_t k = 0; k < held.size(); ++k) {
      for (std::uint64_t value = 0; value < source.shape.value_count(); ++value) {
        const double truth = light(value, k);
        const double sd = std::sqrt(camera.read * camera.read + camera.shot * truth);
        const double error = (light_of[code_at(capture.format(), held[k], value)] - truth) / sd;
        worst = std::max(worst, std::abs(error));
        const bool is_near =
            is_object(value, k) || is_object(value, k + 1) || (k > 0 && is_object(value, k - 1));
        if (is_near) {
          squares += error * error;
          ++count;
        }
      }
    }
    const double rms = std::sqrt(squares / static_cast<double>(count));
    std::printf("%s: object and edges off by %.2f sd, at most %.1f\n", each.name, rms, worst);
    EXPECT_LE(worst, source.noise.sigmas + 6) << each.name;
    EXPECT_LE(rms, 1) << each.name;  // no worse than the frames themselves
  }
}

}  // namespace
}  // namespace nutik::test
