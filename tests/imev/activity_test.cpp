#include <gtest/gtest.h>

#include "imev/activity.hpp"
#include "imev/capture_source.hpp"
#include "support/random_case.hpp"

namespace nutik {
namespace {

using test::RandomCase;

Activity activity_of(const MemoryCapture& capture) {
  Activity activity(capture.format());
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
            differs |= test::code_at(random.capture, random.rasters[k], value) !=
                       test::code_at(random.capture, random.rasters[k - 1], value);
          }
          changes += differs ? 1 : 0;
        }
        ASSERT_EQ(activity.changes()[pixel], changes)
            << random.text() << ", pixel " << pixel << ", blocks of " << block_samples;
      }
    }
  }
}

TEST(Activity, MapIsBlackWhereNothingChangesAndWhiteWhereMostDoes) {
  const Picture map = activity_map({3, 1, 3}, {0, 168, 84});
  const auto codes = map.values<std::uint8_t>();
  EXPECT_EQ(map.shape.channels, 1u);
  EXPECT_EQ(codes[0], 0);
  EXPECT_EQ(codes[1], 255);
  EXPECT_EQ(codes[2], 188);  // half the light
  const Picture still = activity_map({2, 1, 1}, {0, 0});
  EXPECT_EQ(still.values<std::uint8_t>()[1], 0);
}

}  // namespace
}  // namespace nutik
