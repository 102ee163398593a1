#include "imev/source_comparison.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "imev/capture_source.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

SourceComparison compare(const MemoryCapture& capture, const CaptureFormat& source, const Rasters& rasters) {
  SourceComparison comparison(source);
  for (std::uint64_t block = 0; block < capture.block_count(); ++block) {
    const BlockExtent extent = capture.block_extent(block);
    for (std::uint32_t k = 0; k < extent.sample_count; ++k) {
      comparison.add(capture.view(block), k, rasters[extent.first_sample + k]);
    }
  }
  return comparison;
}

// As the capture's own histories tell.
std::uint64_t records_of(const MemoryCapture& capture) {
  const Shape& shape = capture.format().shape;
  std::uint64_t records = 0;
  std::vector<ChangeRecord> history;
  for (std::uint64_t block = 0; block < capture.block_count(); ++block) {
    for (std::uint64_t pixel = 0; pixel < shape.pixel_count(); ++pixel) {
      const auto x = static_cast<std::uint32_t>(pixel % shape.width);
      const auto y = static_cast<std::uint32_t>(pixel / shape.width);
      capture.view(block).read_history(TileGrid(shape).tile_of(x, y), TileGrid::lane_of(x, y), history);
      records += history.size() - 1;
    }
  }
  return records;
}

TEST(SourceComparison, FindsNothingBeyondWhatACapturePromises) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    RandomCase random(seed);
    const SourceComparison with_tolerance = compare(random.encode(), random.capture, random.rasters);
    EXPECT_LE(with_tolerance.worst().error, random.capture.noise.tolerance) << random.text();
    EXPECT_EQ(with_tolerance.values_beyond(), 0u) << random.text();
    EXPECT_EQ(with_tolerance.record_count(), records_of(random.encode())) << random.text();
    EXPECT_EQ(with_tolerance.value_count(), random.rasters.size() * random.capture.shape.value_count());
    if (random.capture.noise.is_lossless()) {
      EXPECT_TRUE(std::isinf(with_tolerance.psnr()));
    }

    const ChannelNoise noise{NoiseCurve::sensor, 0.01, 0.001, {}};
    random.capture.noise = {};
    random.capture.noise.camera =
        CameraNoise{random.capture.white_code, random.capture.transfer,
                    std::vector<ChannelNoise>(random.capture.shape.channels, noise)};
    EXPECT_EQ(compare(random.encode(), random.capture, random.rasters).values_beyond(), 0u) << random.text();
  }
}

// By hand: 2 x 1 grey pixels that hold 100 and 50, and a source that is off by 0, 3, 4 and 5 codes.
TEST(SourceComparison, CountsErrorsInCodes) {
  CaptureFormat format{.shape = {2, 1, 1}};
  const auto raster = [](int a, int b) {
    return std::vector<std::byte>{static_cast<std::byte>(a), static_cast<std::byte>(b)};
  };
  const Rasters held{raster(100, 50), raster(100, 50)};
  const MemoryCapture capture(format, Timeline::constant({10, 1}, Timeline::kFullShutter, 2), held, 2);
  format.noise.tolerance = 4;
  const SourceComparison comparison = compare(capture, format, {raster(100, 53), raster(96, 55)});
  EXPECT_EQ(comparison.worst().error, 5);
  EXPECT_EQ(comparison.worst().sample, 1u);
  EXPECT_EQ(comparison.worst().pixel, 1u);
  EXPECT_EQ(comparison.values_beyond(), 1u);
  EXPECT_NEAR(comparison.psnr(), 10 * std::log10(255.0 * 255 / ((9 + 16 + 25) / 4.0)), 1e-12);
}

}  // namespace
}  // namespace nutik::test
