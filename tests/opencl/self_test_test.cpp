// Drivers are not trusted: what computes wrongly is not taken, and says so when it is asked for.
#include "opencl/self_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>

#include "opencl/build_options.hpp"
#include "opencl/opencl_renderer.hpp"
#include "render/reference_renderer.hpp"
#include "support/comma_locale.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"
#include "support/rendering.hpp"
#include "support/running_program.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

constexpr OutputFormat kCodes{ValueType::code8, 255};
const RenderControl kMeasuring{.takes_wrong = true};

// Light as if codes were linear: what a compiler may make of an sRGB curve.
constexpr const char* kWrongLight = "-DNUTIK_LIGHT=NUTIK_LIGHT_LINEAR";

class SelfTest : public testing::Test {
 protected:
  SelfTest() : capture_(capture()), plan_(plan(capture_)) {}

  static MemoryCapture capture() {
    const CaptureFormat format{.shape = {24, 16, 1}};
    Random random(3);
    return {format, Timeline::constant({100, 1}, Timeline::kFullShutter, 20), random_rasters(random, format, 20), 64};
  }
  static RenderPlan plan(const MemoryCapture& capture) {
    return make_plan(capture, {{0, GainFunction::boxcar(0, 200'000'000)}}, Mask::uniform(24, 16, 0), {});
  }

  [[nodiscard]] OpenClOptions options(const std::vector<Precision>& wrong = {}) const {
    OpenClOptions options;
    options.cache_folder = scratch_ / "cache";
    for (const Precision precision : wrong) options.faults[precision] = kWrongLight;
    return options;
  }

  Rendered render(const OpenClOptions& options, const RenderControl& control = {}) {
    return OpenClRenderer(options).render(plan_, capture_, kCodes, control);
  }

  [[nodiscard]] std::vector<std::filesystem::path> cached(const std::string& extension) const {
    return files_with(scratch_ / "cache", extension);
  }

  // Has every kept verdict say the contrary.
  void turn_verdicts() const {
    for (const auto& file : cached(".txt")) {
      std::string text = read_file(file);
      const std::size_t at = text.find(" right ");
      ASSERT_NE(at, std::string::npos) << text;
      std::ofstream(file, std::ios::binary) << text.replace(at, 7, " wrong ");
    }
  }

  Scratch scratch_;
  MemoryCapture capture_;
  RenderPlan plan_;
};

TEST_F(SelfTest, IsPassedByEveryArithmetic) {
  for (const Precision precision : first_precisions()) {
    OpenClOptions asking = options();
    asking.precision = precision;
    const Rendered rendered = render(asking);
    EXPECT_TRUE(rendered.passed_self_test);
    EXPECT_TRUE(rendered.warnings.empty());
  }
  const auto verdicts = kept_verdicts(0, scratch_ / "cache");
  EXPECT_EQ(verdicts.size(), first_precisions().size());
  for (const auto& [precision, verdict] : verdicts) {
    EXPECT_TRUE(verdict.is_right) << to_text(precision);
    EXPECT_GT(verdict.codes, 1000u);
    EXPECT_GT(verdict.allowed_error, 0.0);
    std::printf("%-11s light is wrong by %.2g, %.2g is allowed\n", to_text(precision).c_str(),
                verdict.light_error, verdict.allowed_error);
  }
}

TEST_F(SelfTest, AutoTakesAnotherArithmetic) {
  const Rendered right = render(options());
  EXPECT_EQ(right.precision, Precision::single_);
  const Rendered rendered = render(options({Precision::single_}));
  EXPECT_NE(rendered.precision, Precision::single_);
  EXPECT_TRUE(rendered.passed_self_test);
  const Picture expected = ReferenceRenderer().render(plan_, capture_, kCodes).picture;
  EXPECT_EQ(rendered.picture.bytes, expected.bytes);
}

TEST_F(SelfTest, AskingForAWrongOneIsRefusedUnlessItIsMeasured) {
  OpenClOptions asking = options({Precision::fixed});
  asking.precision = Precision::fixed;
  expect_error<DeviceError>([&] { return render(asking); },
                            {"this driver computes `fixed` wrongly (self-test: light is wrong by ",
                             "use auto or another arithmetic, another device or the reference"});
  const Rendered measured = render(asking, kMeasuring);
  EXPECT_EQ(measured.precision, Precision::fixed);
  EXPECT_FALSE(measured.passed_self_test);
  asking.tests_itself = false;
  EXPECT_TRUE(render(asking).warnings.empty());
}

TEST_F(SelfTest, ADeviceThatIsAlwaysWrongIsAnError) {
  const auto all = first_precisions();
  std::vector<std::string> parts{"every arithmetic wrongly"};
  for (const Precision precision : all) parts.push_back("\n  " + to_text(precision) + ": light is wrong by ");
  expect_error<DeviceError>([&] { return render(options({all.begin(), all.end()})); }, parts);
}

TEST_F(SelfTest, VerdictsAreKeptAndRenewedWithTheBinaries) {
  EXPECT_EQ(render(options()).precision, Precision::single_);
  ASSERT_EQ(cached(".txt").size(), 1u);
  turn_verdicts();
  EXPECT_NE(render(options()).precision, Precision::single_) << "the kept verdict was not asked for";
  EXPECT_FALSE(kept_verdicts(0, scratch_ / "cache").at(Precision::single_).is_right);

  for (const auto& file : cached(".bin")) std::filesystem::remove(file);
  EXPECT_EQ(render(options()).precision, Precision::single_) << "a verdict outlived its binaries";
  const Verdict kept = kept_verdicts(0, scratch_ / "cache").at(Precision::single_);
  EXPECT_TRUE(kept.is_right);
  const CommaLocale locale;  // without one, once more the same
  EXPECT_EQ(kept_verdicts(0, scratch_ / "cache").at(Precision::single_).light_error, kept.light_error);

  std::ofstream(cached(".txt").front(), std::ios::binary) << "nonsense";
  EXPECT_EQ(render(options()).precision, Precision::single_);
}

// The same kernels: what they make of light says nothing about codes.
TEST_F(SelfTest, APictureOfLightDoesNotVouchForCodes) {
  OpenClOptions asking = options();
  asking.precision = Precision::single_;
  static_cast<void>(OpenClRenderer(asking).render(plan_, capture_, {ValueType::light64, 0}));
  EXPECT_EQ(kept_verdicts(0, scratch_ / "cache").at(Precision::single_).codes, 0u);
  static_cast<void>(render(asking));
  EXPECT_EQ(cached(".txt").size(), 2u);
}

// Light alone does not show what is wrong with codes.
TEST_F(SelfTest, SeesWrongCodes) {
  ReferenceRenderer reference;
  const auto with_codes = [&](std::uint8_t wrong) {
    return self_test(plan_.capture, Precision::single_, kCodes, {},
                     [&](const RenderPlan& plan, CaptureSource& source, const OutputFormat& output) {
                       Picture picture = reference.render(plan, source, output).picture;
                       if (holds_codes(output.type)) picture.values<std::uint8_t>()[100] += wrong;
                       return picture;
                     });
  };
  EXPECT_TRUE(with_codes(0).is_right);
  const Verdict verdict = with_codes(3);
  EXPECT_FALSE(verdict.is_right);
  EXPECT_EQ(fault_text(verdict), "1 of 1247 codes are wrong");
}

// Kernels that blend are tested on a scene that needs them to, and have a verdict of their own.
TEST_F(SelfTest, SeesWrongBlending) {
  OpenClOptions blending = options();
  blending.precision = Precision::single_;
  EXPECT_TRUE(render(blending).passed_self_test);
  Mask soft = Mask::uniform(24, 16, 0);
  soft.mixed.add(7, std::array<Share, 2>{{{0, 60'000}, {1, 5'535}}});
  const GainFunction gain = GainFunction::boxcar(0, 200'000'000);
  plan_ = make_plan(capture_, {{0, gain}, {1, gain}}, soft, {});
  EXPECT_TRUE(render(blending).passed_self_test);
  EXPECT_EQ(cached(".txt").size(), 2u);
  blending.cache_folder.clear();
  blending.faults[Precision::single_] = "-DNUTIK_SHARE_UNIT=1.53e-5f";  // 1/65359
  EXPECT_FALSE(render(blending, kMeasuring).passed_self_test);
  plan_ = plan(capture_);
  EXPECT_TRUE(render(blending).passed_self_test) << "nothing is blended";
}

// What blocks are made of, summed over them.
struct Contents {
  std::uint64_t still = 0, rows = 0, dense = 0, records = 0;
  std::uint64_t longest_block = 0, samples = 0;

  void add(const BlockView& block) {
    const std::uint32_t count = block.extent().sample_count;
    longest_block = std::max<std::uint64_t>(longest_block, count);
    samples = std::max(samples, block.extent().range().last);
    for (std::uint64_t tile = 0; tile < block.geometry().tile_count; ++tile) {
      const TileEntry entry = block.entry(tile);
      ++(entry.is_records() ? records : entry.rows() == 1 ? still : entry.rows() == count ? dense : rows);
    }
  }
};

// All kinds of tiles, both widths of an index and a long time, in every format.
TEST_F(SelfTest, ScenesHaveTilesOfEveryKind) {
  ReferenceRenderer reference;
  for (const std::uint32_t channels : {1u, 3u}) {
    for (const std::uint32_t code_bytes : {1u, 2u}) {
      Contents contents;
      const auto render = [&](const RenderPlan& plan, CaptureSource& source, const OutputFormat& output) {
        const auto& capture = dynamic_cast<const MemoryCapture&>(source);
        for (const PlannedBlock& planned : plan.blocks) contents.add(capture.view(planned.block));
        return reference.render(plan, source, output).picture;
      };
      const CaptureFormat like{
          .shape = {1, 1, channels}, .code_bytes = code_bytes, .white_code = code_bytes == 1 ? 255u : 4095u};
      EXPECT_TRUE(self_test(like, Precision::double_, {ValueType::code16, 4095}, {}, render).is_right);
      EXPECT_GT(std::min({contents.still, contents.rows, contents.dense, contents.records}), 5u)
          << channels << " " << code_bytes;
      EXPECT_GT(contents.longest_block, 255u);
      EXPECT_GT(contents.samples, 65'535u);
    }
  }
}

// Mesa's llvmpipe ends loops early: the self-test of that very driver sees it, and launches that are short enough
// compute rightly.
TEST_F(SelfTest, SeesLoopsThatEndEarly) {
  const std::vector<DeviceInfo> devices = list_devices();
  const auto found =
      std::ranges::find_if(devices, [](const DeviceInfo& device) { return device.loop_limit != 0; });
  if (found == devices.end())
    GTEST_SKIP() << "no device ends loops early (RUSTICL_ENABLE=llvmpipe shows Mesa's)";
  OpenClOptions heeding = options();
  heeding.device = static_cast<std::size_t>(found - devices.begin());
  heeding.precision = Precision::single_;
  EXPECT_TRUE(render(heeding).passed_self_test);
  heeding.cache_folder.clear();
  heeding.heeds_loop_limit = false;
  EXPECT_FALSE(render(heeding, kMeasuring).passed_self_test);
}

}  // namespace
}  // namespace nutik::test
