#include <gtest/gtest.h>

#include "capture/error.hpp"
#include "exposure/function_file.hpp"
#include "render/render_plan.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"

namespace nutik::test {
namespace {

// 4 × 2 pixels, 100 samples a second, blocks of 10 samples.
MemoryCapture capture_of(std::uint32_t samples) {
  const Rasters rasters(samples, std::vector<std::byte>(8, std::byte{50}));
  return {{.shape = {4, 2, 1}}, Timeline::constant({100, 1}, Timeline::kFullShutter, samples), rasters, 10};
}

FunctionSet functions_of(const std::string& text) {
  FunctionSet functions;
  for (const auto& [tag, parsed] : parse_functions(text).functions) functions.emplace(tag, parsed.function);
  return functions;
}

TEST(RenderPlan, TouchesOnlyTheBlocksThatUsedFunctionsNeed) {
  const MemoryCapture capture = capture_of(100);
  const FunctionSet functions = functions_of(
      "M0 [205000000:0], [206000000:1], [207000000:0]\n"  // sample 20
      "M1 [0:1]\n");                                      // everything, but the mask has no 1
  const RenderPlan plan = make_plan(capture, functions, Mask::uniform(4, 2, 0), {});
  ASSERT_EQ(plan.functions.size(), 1u);
  EXPECT_EQ(plan.functions[0].live, (SampleRange{20, 21}));
  ASSERT_EQ(plan.blocks.size(), 1u);
  EXPECT_EQ(plan.blocks[0].block, 2u);
  EXPECT_EQ(plan.functions[0].table->span_in(plan.blocks[0].extent), (SampleSpan{0, 1}));
  EXPECT_EQ(needed_samples(capture.timeline(), functions, Mask::uniform(4, 2, 0), {}), (SampleRange{20, 21}));
  EXPECT_EQ(make_plan(capture, functions, Mask::uniform(4, 2, 0), {.live_all = true}).blocks.size(), 10u);
}

// Files write jumps as steps of 1 ns. Their half nanosecond of light is exposed, and counts as no sample.
TEST(RenderPlan, CountsTheSamplesThatAFunctionMeans) {
  const MemoryCapture capture = capture_of(100);  // 1 s
  const auto samples = [&](const std::string& text, const PlanOptions& options = {}) {
    const RenderPlan plan = make_plan(capture, functions_of(text), Mask::uniform(4, 2, 0), options);
    EXPECT_EQ(exposed_samples(plan.functions[0], capture.timeline()).size(), plan.exposed_sample_count());
    return std::pair(plan.functions[0].live.size(), plan.exposed_sample_count());
  };
  using Counts = std::pair<std::uint64_t, std::uint64_t>;
  EXPECT_EQ(samples("M0 [499999999:0], [500000000:1], [510000000:1], [510000001:0]"), Counts(3, 1));
  EXPECT_EQ(samples("M0 [989999999:0], [990000000:1], [1000000000:1], [1000000001:0]"), Counts(2, 1));
  EXPECT_EQ(samples("M0 [-1:0], [0:-1], [10000000:-1], [10000001:0]"), Counts(2, 1));
  // Ramps of 2 ns are meant, and what is nothing but steps.
  EXPECT_EQ(samples("M0 [499999998:0], [500000000:1], [510000000:1], [510000002:0]"), Counts(3, 3));
  EXPECT_EQ(samples("M0 [499999999:0], [500000000:1], [500000001:0]"), Counts(2, 2));
  EXPECT_EQ(samples("M0 [499999999:0], [500000000:1], [510000000:1], [510000001:0]", {.live_all = true}),
            Counts(100, 100));
}

TEST(RenderPlan, RefusesAMaskThatDoesNotFit) {
  const MemoryCapture capture = capture_of(10);
  const FunctionSet functions = functions_of("M0 [0:1]");
  EXPECT_EQ(message_of<InputError>([&] { return make_plan(capture, functions, Mask::uniform(4, 3, 0), {}); }),
            "the mask is 4 x 3 pixels, the capture 4 x 2; both must have the same size");
  EXPECT_EQ(message_of<InputError>([&] { return make_plan(capture, functions, Mask::uniform(2, 4, 0), {}); }),
            "the mask is 2 x 4 pixels, the capture 4 x 2; turn it by 90 degrees");
  Mask mask = Mask::uniform(4, 2, 0);
  mask.tags[1] = 7;
  mask.tags[5] = 9;
  mask.tags[6] = 9;
  EXPECT_EQ(message_of<InputError>([&] { return make_plan(capture, functions, mask, {}); }),
            "mask values without a function: 7 (1 pixels), 9 (2 pixels); add a line M<value> for each, or "
            "expose them to black");
  EXPECT_EQ(make_plan(capture, functions, mask, {.unmapped_is_zero = true}).functions.size(), 3u);
}

TEST(RenderPlan, WarnsOfWhatDoesNotCount) {
  const MemoryCapture capture = capture_of(100);  // 1 s
  const auto warnings = [&](const std::string& text) {
    return make_plan(capture, functions_of(text), Mask::uniform(4, 2, 0), {}).warnings;
  };
  const auto only = [&](const std::string& text, const std::string& part) {
    const auto found = warnings(text);
    ASSERT_EQ(found.size(), 1u) << text;
    expect_says(found[0], part);
  };
  only("M0 [0:0], [1:0]", "zero everywhere in the capture");
  only("M0 [-5:0], [-4:1], [10:1], [11:0]", "before the capture's start");
  only("M0 [0:1], [2000000000:1], [2000000001:0]", "after the capture's end");
  only("M0 [0:0], [400000000:1]",
       "M0: the last gain, 1, holds to the end of the capture at 1 s; put a gain of 0");
  only("M0 [400000000:1],[410000000:1]",
       "the first gain, 1, holds from the start of the capture, and the last gain, 1, holds to the end");
  EXPECT_TRUE(warnings("M0 [0:1], [10:1], [11:0], [5000000000:0]").empty());  // a held zero end
  EXPECT_TRUE(warnings("M0 [0:1], [1000000000:1], [1000000001:0]").empty());  // a jump at the capture's end
}

// A function's parts outside the domain count in neither integral nor D.
TEST(RenderPlan, NormalizesByWhatLiesInTheCapture) {
  const MemoryCapture capture = capture_of(10);  // 0.1 s
  const RenderPlan plan = make_plan(capture, functions_of("M0 [-100000000:1], [900000000:1], [900000001:0]"),
                                    Mask::uniform(4, 2, 0), {});
  EXPECT_EQ(plan.functions[0].summary.support_ns, 100'000'000);
  EXPECT_DOUBLE_EQ(plan.functions[0].summary.still_gain(), 1.0);
}

}  // namespace
}  // namespace nutik::test
