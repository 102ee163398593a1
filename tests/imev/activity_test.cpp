#include <gtest/gtest.h>

#include <functional>

#include "imev/activity.hpp"
#include "imev/capture_source.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

Activity activity_of(const MemoryCapture& capture, ActivityOptions options = {}) {
  Activity activity(capture.format(), std::move(options));
  for (std::uint64_t block = 0; block < capture.block_count(); ++block) activity.add(capture.view(block));
  return activity;
}

TEST(Activity, CountsChangesWhereverBlocksBegin) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    RandomCase random(seed);
    const std::uint32_t channels = random.capture.shape.channels;
    random.capture.noise.tolerance = 0;
    for (const std::uint32_t block_samples : {1u, 3u, 64u}) {
      const Activity activity =
          activity_of(MemoryCapture(random.capture, random.timeline, random.rasters, block_samples));
      for (std::uint64_t pixel = 0; pixel < random.capture.shape.pixel_count(); ++pixel) {
        std::uint64_t changes = 0;
        for (std::size_t k = 1; k < random.rasters.size(); ++k) {
          bool differs = false;
          for (std::uint64_t value = pixel * channels; value < (pixel + 1) * channels; ++value) {
            differs |= code_at(random.capture, random.rasters[k], value) !=
                       code_at(random.capture, random.rasters[k - 1], value);
          }
          changes += differs ? 1 : 0;
        }
        ASSERT_EQ(activity.changes()[pixel], changes)
            << random.text() << ", pixel " << pixel << ", blocks of " << block_samples;
      }
    }
  }
}

// What ought to be counted at a sample: pixels of which a channel differs by more than `ignored`.
std::uint64_t changed_pixels(const RandomCase& random, std::size_t sample, std::uint32_t ignored,
                             const std::vector<std::uint8_t>& counted) {
  const std::uint32_t channels = random.capture.shape.channels;
  std::uint64_t count = 0;
  for (std::uint64_t pixel = 0; pixel < random.capture.shape.pixel_count(); ++pixel) {
    bool differs = false;
    for (std::uint64_t value = pixel * channels; value < (pixel + 1) * channels; ++value) {
      const auto now = static_cast<int>(code_at(random.capture, random.rasters[sample], value));
      const auto before = static_cast<int>(code_at(random.capture, random.rasters[sample - 1], value));
      differs |= std::abs(now - before) > static_cast<int>(ignored);
    }
    count += differs && (counted.empty() || counted[pixel] != 0) ? 1 : 0;
  }
  return count;
}

TEST(Activity, CountsThePixelsThatChangeAtASample) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    RandomCase random(seed);
    random.capture.noise.tolerance = 0;
    Random draw(seed);
    ActivityOptions options;
    options.ignored_codes = draw.chance(0.5) ? 0 : random.capture.white_code / 4;
    if (draw.chance(0.5)) {
      options.counted.resize(random.capture.shape.pixel_count());
      for (std::uint8_t& counted : options.counted) counted = draw.chance(0.5) ? 1 : 0;
    }
    const MemoryCapture capture = random.encode();
    Activity activity(random.capture, options);
    for (std::uint64_t block = 0; block < capture.block_count(); ++block) activity.add(capture.view(block));
    ASSERT_EQ(activity.changed_pixels().size(), random.rasters.size());
    EXPECT_EQ(activity.changed_pixels()[0], 0u);
    for (std::size_t k = 1; k < random.rasters.size(); ++k) {
      ASSERT_EQ(activity.changed_pixels()[k],
                changed_pixels(random, k, options.ignored_codes, options.counted))
          << random.text() << ", sample " << k << ", ignored " << options.ignored_codes;
    }
  }
}

// 16 x 16 pixels of code 100, of which some have other codes at some samples.
MemoryCapture scene(const std::function<int(std::size_t sample, std::size_t pixel)>& code,
                    std::uint32_t block_samples) {
  std::vector<std::vector<std::byte>> rasters(20, std::vector<std::byte>(256));
  for (std::size_t k = 0; k < rasters.size(); ++k) {
    for (std::size_t pixel = 0; pixel < 256; ++pixel)
      rasters[k][pixel] = static_cast<std::byte>(code(k, pixel));
  }
  const CaptureFormat capture{.shape = {16, 16, 1}};
  return {capture, Timeline::constant({100, 1}, Timeline::kFullShutter, rasters.size()), rasters, block_samples};
}

TEST(RedrawnSamples, AreThoseAtWhichAllChangesAtOnceAndALittle) {
  const auto redrawn = [](const std::function<int(std::size_t, std::size_t)>& code) {
    return redrawn_samples(activity_of(scene(code, 7)));
  };
  using Samples = std::vector<std::uint64_t>;
  // Two key frames, the second where a block begins, beside an eighth of the picture that moves all the time.
  const auto moving = [](std::size_t k, std::size_t pixel) {
    return pixel < 32 ? static_cast<int>(k * 12) : 100;
  };
  EXPECT_EQ(redrawn([&](std::size_t k, std::size_t pixel) {
              return moving(k, pixel) + (k >= 14 ? 3 : k >= 5 ? 2 : 0);
            }),
            (Samples{5, 14}));
  EXPECT_EQ(redrawn(moving), Samples{});
  // A cut, a flash, a fade over two samples, less than a quarter of the picture.
  EXPECT_EQ(redrawn([](std::size_t k, std::size_t) { return k >= 9 ? 180 : 100; }), Samples{});
  EXPECT_EQ(redrawn([](std::size_t k, std::size_t) { return k == 9 ? 180 : 100; }), Samples{});
  EXPECT_EQ(redrawn([](std::size_t k, std::size_t) { return k > 9 ? 104 : k == 9 ? 102 : 100; }), Samples{});
  EXPECT_EQ(redrawn([](std::size_t k, std::size_t pixel) { return k >= 9 && pixel < 63 ? 102 : 100; }),
            Samples{});
  EXPECT_EQ(redrawn([](std::size_t k, std::size_t pixel) { return k >= 9 && pixel < 64 ? 102 : 100; }),
            Samples{9});
  // Whatever the mask, all pixels tell.
  ActivityOptions corner;
  corner.counted.assign(256, 0);
  corner.counted[0] = 1;
  corner.ignored_codes = 9;
  EXPECT_EQ(redrawn_samples(activity_of(
                scene([](std::size_t k, std::size_t) { return k >= 9 ? 102 : 100; }, 64), corner)),
            Samples{9});
}

TEST(Activity, BridgesSamplesThatAreLeftOut) {
  // 10 pixels change with every sample, all of them at samples 6 and 19, the last.
  const MemoryCapture capture = scene(
      [](std::size_t k, std::size_t pixel) {
        return 100 + (pixel < 10 ? static_cast<int>(k % 2) * 50 : k >= 19 ? 4 : k >= 6 ? 2 : 0);
      },
      4);
  ActivityOptions options;
  options.left_out = {6, 19};
  Activity activity = activity_of(capture, options);
  EXPECT_EQ(activity.changed_pixels()[6], 0u);
  activity.bridge_left_out();
  for (std::size_t k = 1; k < 20; ++k) EXPECT_EQ(activity.changed_pixels()[k], 10u) << k;
  EXPECT_EQ(activity.changes()[0], 17u);
  EXPECT_EQ(activity.changes()[10], 0u);
  EXPECT_EQ(activity.any_changed_pixels()[6], 256u);
}

TEST(ActivityMoments, AreTheBusiestAndTheQuietestStretch) {
  std::vector<std::uint64_t> changes(100, 50);  // stretches of 5 samples
  changes[0] = 0;                               // has no change and lies in no stretch
  changes[30] = 90;
  for (std::size_t k = 70; k < 75; ++k) changes[k] = 60;
  for (std::size_t k = 40; k < 45; ++k) changes[k] = 2;
  const auto moments = activity_moments(changes);
  ASSERT_TRUE(moments);
  EXPECT_EQ(moments->busiest_sample, 30u);
  EXPECT_EQ(moments->busiest.samples, (SampleRange{70, 75}));
  EXPECT_EQ(moments->busiest.changes, 300u);
  EXPECT_EQ(moments->quietest.samples, (SampleRange{40, 45}));
  EXPECT_EQ(moments->quietest.changes, 10u);
}

TEST(ActivityMoments, AreNoneWhereThereIsNothingToTellApart) {
  EXPECT_FALSE(activity_moments(std::vector<std::uint64_t>(50, 0)));
  EXPECT_FALSE(activity_moments(std::vector<std::uint64_t>{0, 9}));
  EXPECT_FALSE(activity_moments(std::vector<std::uint64_t>{}));
  const auto shortest = activity_moments(std::vector<std::uint64_t>{0, 9, 3});
  ASSERT_TRUE(shortest);
  EXPECT_EQ(shortest->busiest.samples, (SampleRange{1, 2}));
  EXPECT_EQ(shortest->quietest.samples, (SampleRange{2, 3}));
}

}  // namespace
}  // namespace nutik::test
