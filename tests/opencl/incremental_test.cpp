// What is on the device from the render before is not written again, and no picture shows that it was not.
#include <gtest/gtest.h>

#include "opencl/kernel_numbers.hpp"
#include "opencl/work_shape.hpp"
#include "render/plan_cache.hpp"
#include "support/random_case.hpp"
#include "support/rendering.hpp"

namespace nutik::test {
namespace {

constexpr std::uint32_t kWidth = 64, kHeight = 64, kSamples = 50, kBlockSamples = 10;

// 64 functions, each in its own tile, and pixels of all of them in the first one.
class Incremental : public OfPrecision {
 protected:
  Incremental() {
    Random random(1);
    const CaptureFormat format{.shape = {kWidth, kHeight, 3}};
    capture_.emplace(format, Timeline::constant({100, 1}, {180, 1}, kSamples), random_rasters(random, format, kSamples),
                     kBlockSamples);
    mask_ = Mask::uniform(kWidth, kHeight, 0);
    for (std::uint32_t y = 0; y < kHeight; ++y) {
      for (std::uint32_t x = 0; x < kWidth; ++x) {
        const std::uint32_t tile = y / 8 * 8 + x / 8;
        mask_.tags[y * kWidth + x] = static_cast<std::uint8_t>(tile == 0 ? y * 8 + x : tile);
      }
    }
    for (std::uint32_t tag = 0; tag < 64; ++tag) {
      functions_.emplace(static_cast<std::uint8_t>(tag), function_of(tag, 200'000'000));
    }
  }

  static GainFunction function_of(std::uint32_t tag, std::int64_t time_ns) {
    return GainFunction({{0, 0.5}, {time_ns, 0.01 * tag}, {400'000'000, 1.0}});
  }

  // A render beside those before, and one of a renderer and a plan that know of none.
  RenderStatistics render() {
    const OutputFormat output{ValueType::light64, 0};
    const Rendered rendered =
        renderer_.render(cache_.plan(*capture_, functions_, mask_, {}), *capture_, output);
    OpenClRenderer fresh(options());
    const RenderPlan plan = make_plan(*capture_, functions_, mask_, {});
    EXPECT_EQ(rendered.picture.bytes, fresh.render(plan, *capture_, output).picture.bytes);
    return rendered.statistics;
  }

  // A function's number for each pixel, the tags, and the list of tiles that are exposed.
  static constexpr std::uint64_t kTiles = std::uint64_t{kWidth / kTileSide} * (kHeight / kTileSide);
  static constexpr std::uint64_t kMapBytes = std::uint64_t{kWidth} * kHeight + 64 * 2 + 4 * kTiles;

  std::optional<MemoryCapture> capture_;
  Mask mask_;
  FunctionSet functions_;
  PlanCache cache_;
  OpenClRenderer renderer_{options()};

  static std::uint32_t table_rows() {
    return work_shape(options(), GetParam(), list_devices().front()).table_rows();
  }
  static constexpr std::uint64_t kRows = kSamples + kSamples / kBlockSamples;
  // What one function takes: a row for each sample and one more for each block, of boundaries and, in whole groups of
  // rows, of weights; a part and a gain for each block.
  const std::uint64_t column_bytes_ =
      (kRows + align_up(kRows, table_rows())) * weight_bytes(GetParam()) +
      kSamples / kBlockSamples * (sizeof(BlockPart) + weight_bytes(GetParam()));
};

TEST_P(Incremental, AMovedPointWritesOneColumn) {
  const RenderStatistics first = render();
  EXPECT_EQ(first.table_bytes_written, 64 * column_bytes_);
  EXPECT_EQ(first.map_bytes_written, kMapBytes);
  EXPECT_EQ(cache_.statistics().tables_made, 64u);
  const RenderStatistics again = render();
  EXPECT_EQ(again.table_bytes_written, 0u);
  EXPECT_EQ(again.map_bytes_written, 0u);
  for (const std::uint8_t tag : {std::uint8_t{0}, std::uint8_t{63}, std::uint8_t{17}}) {
    functions_.at(tag) = function_of(tag, 230'000'000);
    const RenderStatistics moved = render();
    EXPECT_EQ(moved.table_bytes_written, column_bytes_);
    EXPECT_EQ(moved.map_bytes_written, 0u);
  }
  EXPECT_EQ(cache_.statistics().tables_made, 67u);
  functions_.at(17) = function_of(17, 200'000'000);  // back: the table is still there, the column is not
  EXPECT_EQ(render().table_bytes_written, column_bytes_);
  EXPECT_EQ(cache_.statistics().tables_made, 67u);
}

TEST_P(Incremental, AnotherMaskWritesNoTable) {
  static_cast<void>(render());
  std::ranges::reverse(mask_.tags);
  const RenderStatistics painted = render();
  EXPECT_EQ(painted.table_bytes_written, 0u);
  EXPECT_EQ(painted.map_bytes_written, kMapBytes);
  std::ranges::reverse(mask_.tags);
  EXPECT_EQ(render().map_bytes_written, 0u);
  // One that leaves a function out puts the others elsewhere: written again, but not made again.
  std::ranges::replace(mask_.tags, std::uint8_t{9}, std::uint8_t{10});
  EXPECT_EQ(render().table_bytes_written, 63 * column_bytes_);
  EXPECT_EQ(cache_.statistics().tables_made, 64u);
}

// Functions that need other blocks, or nothing at all, one after another.
TEST_P(Incremental, FollowsFunctionsThroughTheCapture) {
  for (const std::int64_t start_ns : {0, 105'000'000, 390'000'000, 900'000'000, 60'000'000}) {
    for (auto& [tag, function] : functions_) {
      function = GainFunction::boxcar(start_ns + tag * 1'000'000, start_ns + 70'000'000 + tag * 500'000);
    }
    static_cast<void>(render());
    functions_.at(5) = GainFunction::boxcar(0, 480'000'000);
    static_cast<void>(render());
  }
}

INSTANTIATE_TEST_SUITE_P(, Incremental, testing::ValuesIn(kPrecisions),
                         [](const auto& instance) { return to_text(instance.param); });

// Slices that do not fit are written as often as they are read; in little memory the picture is the same.
TEST(IncrementalInLittleMemory, RendersTheSame) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const RandomCase random(seed, {3, 1, 255, Transfer::srgb()});
    MemoryCapture capture = random.encode(4, TilePolicy::automatic);
    OpenClOptions options = renderer_options(precise());
    OpenClRenderer plain(options);
    options.memory_bytes = 40'000;
    OpenClRenderer small(options);
    PlanCache cache(1000);
    const OutputFormat output{ValueType::light64, 0};
    const RenderPlan plan = cache.plan(capture, random.functions, random.mask, {});
    const Picture expected = plain.render(plan, capture, output).picture;
    for (int run = 0; run < 3; ++run) {
      EXPECT_EQ(small.render(plan, capture, output).picture.bytes, expected.bytes) << random.text();
    }
  }
}

}  // namespace
}  // namespace nutik::test
