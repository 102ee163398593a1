// Soft masks on the device: every arithmetic within its bound, hard parts as they are of a hard mask, whole numbers as
// they are defined.
#include <gtest/gtest.h>

#include <cmath>

#include "capture/format.hpp"
#include "opencl/build_options.hpp"
#include "opencl/kernel_layout.hpp"
#include "render/fixed_scale.hpp"
#include "support/precision_check.hpp"
#include "support/random_case.hpp"
#include "support/rendering.hpp"
#include "support/seeds.hpp"
#include "support/soft_mask.hpp"

namespace nutik::test {
namespace {

TEST(SoftMasks, StayWithinTheirBoundsOnRandomCases) {
  PrecisionCheck check;
  const Seeds seeds = test::seeds(0, 150);
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    RandomCase random(seed);
    soften(random.mask, random.functions, seed);
    MemoryCapture capture = random.encode();
    const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
    check.check(plan, capture, format("Soft{}", seed), rerun(seed));
    if (HasFailure()) FAIL() << random.text();
  }
  check.print();
}

// A picture of 99 x 45 pixels and 40 samples, four functions, mixed in part.
struct SoftScene {
  explicit SoftScene(std::uint64_t seed = 3) {
    format.shape = {99, 45, 3};
    Random random(seed);
    rasters = random_rasters(random, format, 40);
    for (const std::uint8_t tag : std::vector<std::uint8_t>{0, 9, 100, 255})
      functions.emplace(tag, random_function(random, timeline));
    hard = Mask::uniform(99, 45, 0);
    for (std::size_t pixel = 0; pixel < hard.tags.size(); ++pixel)
      hard.tags[pixel] = pixel % 99 < 50 ? 9 : 255;
    // A band of mixed pixels down the middle, and one pixel by itself.
    soft = hard;
    for (std::uint64_t pixel = 0; pixel < hard.tags.size(); ++pixel) {
      const std::uint64_t x = pixel % 99;
      if (pixel != 3 && (x < 45 || x > 58 || random.chance(0.3))) continue;
      soft.mixed.add(pixel, random_shares(random, {9, 255, 100}));
    }
  }
  [[nodiscard]] MemoryCapture capture() const { return {format, timeline, rasters, 2}; }
  // Whether a tile has a mixed pixel.
  [[nodiscard]] static bool is_mixed(std::uint64_t x, std::uint64_t y) {
    return (x >= 40 && x < 64) || (x < 8 && y < 8);
  }

  CaptureFormat format;
  Timeline timeline = Timeline::constant({100, 1}, {180, 1}, 40);
  Rasters rasters;
  FunctionSet functions;
  Mask hard, soft;
};

std::uint64_t bits_at(const Picture& picture, std::uint64_t value) {
  if (picture.type == ValueType::light64)
    return std::bit_cast<std::uint64_t>(picture.values<double>()[value]);
  return picture.values<std::uint16_t>()[value];
}

TEST(SoftMasks, LeaveOtherTilesAndWholeSharesAsTheyAre) {
  const SoftScene scene;
  MemoryCapture capture = scene.capture();
  const RenderPlan hard = make_plan(capture, scene.functions, scene.hard, {});
  const RenderPlan soft = make_plan(capture, scene.functions, scene.soft, {});
  for (const Precision precision : first_precisions()) {
    OpenClRenderer renderer(renderer_options(precision));
    for (const OutputFormat& output : {kLight, OutputFormat{ValueType::code16, 65'535}}) {
      const Picture of_hard = renderer.render(hard, capture, output).picture;
      const Picture of_soft = renderer.render(soft, capture, output).picture;
      std::uint64_t changed = 0;
      for (std::uint64_t value = 0; value < of_hard.shape.value_count(); ++value) {
        const std::uint64_t pixel = value / 3;
        if (!soft.shares_of(pixel).empty()) {
          changed += bits_at(of_hard, value) != bits_at(of_soft, value);
          continue;
        }
        // Whole numbers are blended with fewer bits.
        if (precision == Precision::fixed && SoftScene::is_mixed(pixel % 99, pixel / 99)) continue;
        ASSERT_EQ(bits_at(of_hard, value), bits_at(of_soft, value))
            << to_text(precision) << ", value " << value;
      }
      EXPECT_GT(changed, 500u) << "nothing was mixed";
    }
  }
}

TEST(SoftMasks, DoNotDependOnHowTheWorkIsCut) {
  const SoftScene scene;
  MemoryCapture capture = scene.capture();
  const RenderPlan plan = make_plan(capture, scene.functions, scene.soft, {});
  for (const Precision precision : first_precisions()) {
    OpenClRenderer whole(renderer_options(precision));
    OpenClOptions cut = renderer_options(precision);
    cut.allocation_bytes = 60'000;  // a few rows of tiles at a time
    cut.chunk_bytes = 1;
    OpenClRenderer small(cut);
    for (const OutputFormat& output : {kLight, OutputFormat{ValueType::code8, 255}}) {
      const Picture expected = whole.render(plan, capture, output).picture;
      const Rendered in_bands = small.render(plan, capture, output);
      EXPECT_GT(in_bands.statistics.launches, in_bands.statistics.blocks) << "one band";
      EXPECT_EQ(in_bands.picture, expected) << to_text(precision);
      const Rectangle rectangle{37, 5, 20, 33};
      const Picture part = whole.render(plan, capture, output, {.rectangle = rectangle}).picture;
      ASSERT_TRUE(part.bytes == part_of(expected, rectangle)) << to_text(precision);
    }
  }
}

// One sample of linear light, whose weight is 1: functions of constant gain, one for each tag from 0 on, and a pixel
// for each mixture of them.
struct Mixtures {
  std::vector<double> gains;
  std::uint32_t code = 0, white_code = 0;
  std::vector<std::vector<Share>> pixels;

  [[nodiscard]] CaptureFormat format() const {
    return {{static_cast<std::uint32_t>(pixels.size()), 1, 1}, 2, white_code, Transfer::linear(), {}};
  }
  [[nodiscard]] MemoryCapture capture() const {
    std::vector<std::byte> raster(format().sample_bytes());
    for (std::uint64_t pixel = 0; pixel < pixels.size(); ++pixel) set_code(format(), raster, pixel, code);
    return {format(), Timeline::constant({100, 1}, Timeline::kFullShutter, 1), Rasters{raster}, 1};
  }
  [[nodiscard]] RenderPlan plan(const MemoryCapture& capture) const {
    FunctionSet functions;
    for (std::size_t tag = 0; tag < gains.size(); ++tag) {
      functions.emplace(static_cast<std::uint8_t>(tag), GainFunction({{0, gains[tag]}}));
    }
    Mask mask = Mask::uniform(static_cast<std::uint32_t>(pixels.size()), 1, 0);
    for (std::uint64_t pixel = 0; pixel < pixels.size(); ++pixel) {
      if (pixels[pixel].size() == 1) continue;
      mask.mixed.add(pixel, pixels[pixel]);
      mask.tags[pixel] =
          static_cast<std::uint8_t>(std::ranges::max_element(pixels[pixel], {}, &Share::size)->of);
    }
    return make_plan(capture, functions, mask, {});
  }
};

// The definition in docs/explanation/accuracy.md, computed again in integers of 128 bits.
TEST(SoftMasks, OfWholeNumbersAreRoundedAsDefined) {
  Mixtures mixtures{{0.75, -1.5, 3.3, 1e-3, 1000.25}, 2917, 4095, {}};
  Random random(11);
  for (int i = 0; i < 3000; ++i) {
    const std::vector<std::vector<std::uint8_t>> names{{0, 1}, {0, 2}, {0, 1, 2}, {3, 2, 1, 0}, {0, 4}};
    mixtures.pixels.push_back(random_shares(random, random.pick(names)));
  }
  MemoryCapture capture = mixtures.capture();
  const RenderPlan plan = mixtures.plan(capture);
  OpenClRenderer renderer(renderer_options(Precision::fixed));
  const Picture codes = renderer.render(plan, capture, {ValueType::code16, 65'535}).picture;

  using Whole = int128;
  const FixedScale scale = fixed_scale(plan);
  const int below_white = 61 - scale.light_bits - scale.blend_shift;  // 2^this · white code is light 1
  const auto floor_shift = [](Whole value, int left) { return left >= 0 ? value << left : value >> -left; };
  std::uint64_t seen = 0;
  for (std::size_t pixel = 0; pixel < mixtures.pixels.size(); ++pixel) {
    Whole blend = 0;
    for (const Share& share : mixtures.pixels[pixel]) {
      const int exponent = plan.functions[share.of].summary.exponent;
      const double weight = std::scalbn(mixtures.gains[share.of], scale.exponents[share.of] - exponent);
      const Whole sum = static_cast<Whole>(std::llrint(weight)) * mixtures.code;
      blend += share.size * floor_shift(sum, exponent - scale.exponents[share.of] + below_white);
    }
    const Whole light = blend <= 0 ? 0 : blend / 65'535;
    const Whole white = floor_shift(mixtures.white_code, below_white);
    // The last code c with c − ½ of 65535 parts of white at most the light.
    const Whole code = std::min<Whole>((light * 65'535 * 2 + white) / (2 * white), 65'535);
    ASSERT_EQ(codes.values<std::uint16_t>()[pixel], static_cast<std::uint16_t>(code)) << "pixel " << pixel;
    seen += code > 0 && code < 65'535;
  }
  EXPECT_GT(seen, 1000u);
}

// A share of single precision that is rounded down.
bool rounds_down(const Share& share) {
  const float number = static_cast<float>(share.size) * 0x1.0001p-16f;
  return static_cast<double>(number) * kWholeShare < share.size;
}

// How near arithmetics come to their bound: of codes that are not the exact ones, the light that lies furthest from the
// edge between both. In single precision weights and shares are all rounded down.
TEST(SoftMasks, KeepToTheirBoundWhereCodesAreClose) {
  const double just_above = 0.5 + 0x1p-25 * 0.99;  // what floats above a half round down
  Mixtures mixtures{
      {just_above, just_above + 0x1p-12, just_above + 0x1p-9, -just_above / 2}, 32'768, 32'768, {}};
  Random random(5);
  while (mixtures.pixels.size() < 60'000) {
    std::vector<Share> shares = random_shares(random, {0, 1, static_cast<std::uint8_t>(random.whole(2, 3))});
    if (std::ranges::all_of(shares, rounds_down)) mixtures.pixels.push_back(std::move(shares));
  }
  MemoryCapture capture = mixtures.capture();
  const RenderPlan plan = mixtures.plan(capture);
  const OutputFormat output{ValueType::code16, 65'535};
  for (const Precision precision : first_precisions()) {
    const ErrorBound bound = error_bound(plan, precision, output);
    const PixelErrors errors(plan, bound);
    for (const bool fuses : {true, false}) {
      OpenClOptions options = renderer_options(precision);
      options.use_fma = fuses;
      const Picture codes = OpenClRenderer(options).render(plan, capture, output).picture;
      double most = 0.0;
      for (std::size_t pixel = 0; pixel < mixtures.pixels.size(); ++pixel) {
        long double place = 0.0;
        for (const Share& share : mixtures.pixels[pixel])
          place += share.size * static_cast<long double>(mixtures.gains[share.of]);
        place = std::max(place, 0.0L);
        const auto distance =
            static_cast<double>(std::fabs(codes.values<std::uint16_t>()[pixel] - place) - 0.5L);
        most = std::max(most, distance / errors.of(pixel).steps);
      }
      std::printf("%s, %s: %.3f of the bound\n", to_text(precision).c_str(), fuses ? "fused" : "not fused",
                  most);
      EXPECT_LE(most, 1.0) << to_text(precision);
      if (precision == Precision::single_) {
        EXPECT_GE(most, 0.05) << "the bound is looser than it need be";
      }
    }
  }
}

// What kernels work through: of a hard mask each tile once and nothing else, of a soft one the mixed tiles once for
// each of their functions, as tiles that have that function alone.
TEST(SoftMasks, TakeAUniformTileForEachFunctionAndHardMasksNoMoreThanTheirTiles) {
  const SoftScene scene;
  const Rectangle all = Rectangle::whole(scene.format.shape);
  const TileGrid grid(scene.format.shape);
  const auto mapped = [&](const Mask& mask) {
    const auto map = MaskMap::of(mask);
    const std::vector<Band> bands = cut_picture(scene.format.shape, all, Precision::single_, device_allocating(1 << 30),
                                                ~std::uint64_t{0}, map->mixed_tiles);
    EXPECT_EQ(bands.size(), 1u);
    FunctionMap functions = map_functions(*map, bands[0]);
    EXPECT_EQ(functions.tiles.size(), bands[0].sum_tiles);
    return functions;
  };
  const FunctionMap hard = mapped(scene.hard);
  EXPECT_EQ(hard.tiles.size(), grid.tile_count());
  EXPECT_TRUE(hard.first_of.empty() && hard.shares.empty());
  EXPECT_EQ(hard.bytes(), grid.tile_count() * (kTilePixels + 4 + 2));

  const FunctionMap soft = mapped(scene.soft);
  ASSERT_EQ(soft.first_of.size(), grid.tile_count() + 1);
  std::uint32_t mixed_tiles = 0;
  for (std::uint64_t tile = 0; tile < grid.tile_count(); ++tile) {
    const std::uint64_t x = tile % grid.columns() * kTileSide, y = tile / grid.columns() * kTileSide;
    const std::uint32_t first = soft.first_of[tile], last = soft.first_of[tile + 1];
    if (!SoftScene::is_mixed(x, y)) {
      EXPECT_EQ(last - first, 1u) << tile;
      EXPECT_NE(soft.of_tile[first], kMixedFunctions) << tile;
      continue;
    }
    ++mixed_tiles;
    EXPECT_GE(last - first, 2u) << tile;
    EXPECT_LE(last - first, 3u) << "a pixel has a share of 9, 100 and 255: " << tile;
    for (std::uint32_t sum = first; sum < last; ++sum) EXPECT_NE(soft.of_tile[sum], kMixedFunctions) << tile;
  }
  EXPECT_EQ(mixed_tiles, 3 * grid.rows() + 1);
}

}  // namespace
}  // namespace nutik::test
