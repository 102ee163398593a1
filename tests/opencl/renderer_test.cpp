// The OpenCL renderer against the reference, on random captures, functions and masks.
#include "opencl/opencl_renderer.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "render/reference_renderer.hpp"
#include "support/bounds.hpp"
#include "support/random_case.hpp"

namespace nutik {
namespace {

using test::RandomCase;

// Kernels are built once for all tests of this file.
std::filesystem::path shared_cache() {
  static const std::filesystem::path folder = std::filesystem::temp_directory_path() / "nutik-test-kernels";
  return folder;
}

OpenClOptions options_for(Precision precision) {
  OpenClOptions options;
  options.precision = precision;
  options.cache_folder = shared_cache();
  return options;
}

double scale_of(const RenderPlan& plan, std::uint64_t value) {
  return plan.functions[plan.function_of_pixel[value / plan.capture.shape.channels]].summary.error_scale();
}

// The largest difference in light, in units of S. NaN counts as infinite.
double worst_difference(const RenderPlan& plan, const Picture& a, const Picture& b, std::uint64_t& where) {
  double worst = 0.0;
  for (std::uint64_t i = 0; i < a.shape.value_count(); ++i) {
    const double difference = std::fabs(a.values<double>()[i] - b.values<double>()[i]);
    const double scale = scale_of(plan, i);
    double units = difference == 0.0 ? 0.0 : difference / scale;
    if (std::isnan(units)) units = INFINITY;
    if (units > worst) {
      worst = units;
      where = i;
    }
  }
  return worst;
}

TEST(OpenClRenderer, AgreesWithTheReferenceInDouble) {
  OpenClRenderer renderer(options_for(Precision::double_));
  ReferenceRenderer reference;
  double worst = 0.0;
  std::uint64_t codes = 0, differing = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const RandomCase random(seed);
    MemoryCapture capture = random.encode();
    const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
    const Picture light = renderer.render(plan, capture, {ValueType::light64, 0});
    const Picture expected = reference.render(plan, capture, {ValueType::light64, 0});
    std::uint64_t where = 0;
    const double difference = worst_difference(plan, light, expected, where);
    ASSERT_LE(difference, test::kDoubleAgainstReference)
        << random.text() << ", value " << where << ": " << light.values<double>()[where] << " and "
        << expected.values<double>()[where] << "; rerun: opencl_tests --gtest_filter=*Reference*";
    worst = std::max(worst, difference);

    // The same 8-bit codes, but for light within that bound of a rounding edge.
    const Picture picture = renderer.render(plan, capture, {ValueType::code8, 255});
    const Picture expected_picture = reference.render(plan, capture, {ValueType::code8, 255});
    const auto thresholds = plan.capture.transfer.code_thresholds(255);
    for (std::uint64_t i = 0; i < picture.shape.value_count(); ++i) {
      ++codes;
      const std::uint8_t a = picture.values<std::uint8_t>()[i];
      const std::uint8_t b = expected_picture.values<std::uint8_t>()[i];
      if (a == b) continue;
      ++differing;
      const double edge = thresholds[std::max(a, b)];
      const double bound = test::kDoubleAgainstReference * scale_of(plan, i);
      ASSERT_LE(std::fabs(expected.values<double>()[i] - edge), bound) << random.text() << ", value " << i;
      ASSERT_EQ(std::abs(a - b), 1) << random.text() << ", value " << i;
    }
  }
  std::printf("worst difference: %.3g of ∫|g|/D; %llu of %llu codes differ, all at rounding edges\n", worst,
              static_cast<unsigned long long>(differing), static_cast<unsigned long long>(codes));
}

// However the work is cut, the picture is the same within the bound.
TEST(OpenClRenderer, DoesNotDependOnHowTheWorkIsCut) {
  struct Cut {
    std::uint32_t item_pixels, lanes, group_items;
    std::uint64_t chunk_bytes;
  };
  const Cut cuts[] = {{1, 1, 1, 0}, {1, 1, 64, 1}, {4, 4, 3, 0}, {8, 8, 16, 4096}, {16, 16, 2, 0}, {64, 4, 1, 1}};
  ReferenceRenderer reference;
  for (const Cut& cut : cuts) {
    OpenClOptions options = options_for(Precision::double_);
    options.item_pixels = cut.item_pixels;
    options.lanes = cut.lanes;
    options.group_items = cut.group_items;
    options.chunk_bytes = cut.chunk_bytes;
    OpenClRenderer renderer(options);
    for (std::uint64_t seed = 1000; seed < 1030; ++seed) {
      const RandomCase random(seed);
      MemoryCapture capture = random.encode();
      const RenderPlan plan = make_plan(capture, random.functions, random.mask, {});
      std::uint64_t where = 0;
      const double difference =
          worst_difference(plan, renderer.render(plan, capture, {ValueType::light64, 0}),
                           reference.render(plan, capture, {ValueType::light64, 0}), where);
      ASSERT_LE(difference, test::kDoubleAgainstReference)
          << random.text() << ", " << cut.item_pixels << " pixels an item, value " << where;
    }
  }
}

// Every kind of tile and length of block holds the same capture.
TEST(OpenClRenderer, DoesNotDependOnTilesOrBlocks) {
  OpenClRenderer renderer(options_for(Precision::double_));
  for (std::uint64_t seed = 2000; seed < 2020; ++seed) {
    const RandomCase random(seed);
    MemoryCapture plain = random.encode(64, TilePolicy::dense);
    const RenderPlan plan = make_plan(plain, random.functions, random.mask, {});
    const Picture expected = renderer.render(plan, plain, {ValueType::light64, 0});
    for (const std::uint32_t block_samples : {1u, 2u, 64u, 1000u}) {
      for (const TilePolicy policy :
           {TilePolicy::automatic, TilePolicy::dense, TilePolicy::rows, TilePolicy::records}) {
        MemoryCapture capture = random.encode(block_samples, policy);
        const RenderPlan other = make_plan(capture, random.functions, random.mask, {});
        std::uint64_t where = 0;
        const double difference = worst_difference(
            plan, renderer.render(other, capture, {ValueType::light64, 0}), expected, where);
        ASSERT_LE(difference, test::kDoubleAgainstReference)
            << random.text() << ", blocks of " << block_samples << ", tiles " << to_text(policy);
      }
    }
  }
}

TEST(OpenClRenderer, NothingLiveIsBlack) {
  const RandomCase random(1);
  MemoryCapture capture = random.encode();
  const FunctionSet zero{{0, GainFunction({{0, 0.0}})}};
  const Mask mask = Mask::uniform(random.capture.shape.width, random.capture.shape.height, 0);
  const RenderPlan plan = make_plan(capture, zero, mask, {});
  OpenClRenderer renderer(options_for(Precision::double_));
  const Picture picture = renderer.render(plan, capture, {ValueType::code8, 255});
  for (const std::uint8_t code : picture.values<std::uint8_t>()) ASSERT_EQ(code, 0);
  EXPECT_EQ(renderer.statistics().launches, 0u);
}

TEST(OpenClRenderer, ReadsOnlyTheBlocksOfThePlan) {
  CaptureFormat format;
  format.shape = {16, 16, 1};
  const test::Rasters rasters(100, std::vector<std::byte>(256, std::byte{90}));
  MemoryCapture capture(format, Timeline::constant({100, 1}, Timeline::kFullShutter, 100), rasters, 10);
  const FunctionSet functions{{0, GainFunction::boxcar(250'000'000, 260'000'000)}};
  const RenderPlan plan = make_plan(capture, functions, Mask::uniform(16, 16, 0), {});
  OpenClRenderer renderer(options_for(Precision::double_));
  const Picture picture = renderer.render(plan, capture, {ValueType::code8, 255});
  EXPECT_EQ(renderer.statistics().blocks, 1u);
  EXPECT_EQ(renderer.statistics().payload_bytes, 64u + 4 * 64u);  // a directory and four still tiles
  EXPECT_EQ(picture.values<std::uint8_t>()[0], 90);
}

}  // namespace
}  // namespace nutik
