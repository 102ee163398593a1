// Many pictures in one pass: against the reference, within the bound of double, whatever the blocks, tiles and
// rectangle.
#include "render/one_pass.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "capture/error.hpp"
#include "render/reference_renderer.hpp"
#include "support/random_case.hpp"
#include "support/seeds.hpp"

namespace nutik::test {
namespace {

TEST(OnePass, StaysWithinTheBoundOfDouble) {
  const Seeds seeds = test::seeds(0, 60);
  double worst = 0.0;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    const RandomCase random(seed);
    MemoryCapture capture = random.encode();
    const Shape& shape = random.capture.shape;
    const Mask mask = Mask::uniform(shape.width, shape.height, 0);
    std::vector<RenderPlan> plans;
    Random more(seed);
    for (int k = 0; k < 5; ++k)
      plans.push_back(make_plan(capture, {{0, random_function(more, random.timeline)}}, mask, {}));
    ASSERT_TRUE(suits_one_pass(plans.front()));
    Rectangle part = Rectangle::whole(shape);
    if (more.chance(0.5)) {
      part.x = part.width / 3;
      part.y = part.height / 2;
      part.width -= part.x;
      part.height -= part.y;
    }
    const std::vector<Picture> made = expose_in_one_pass(plans, capture, part, {});
    ASSERT_EQ(made.size(), plans.size());
    for (std::size_t i = 0; i < plans.size(); ++i) {
      const double bound = error_bound(plans[i], Precision::double_, kLight).worst.light;
      const Picture wanted = ReferenceRenderer().render(plans[i], capture, kLight, {.rectangle = part}).picture;
      ASSERT_EQ(made[i].shape, wanted.shape);
      for (std::size_t v = 0; v < wanted.values<double>().size(); ++v) {
        const double error = std::fabs(made[i].values<double>()[v] - wanted.values<double>()[v]);
        ASSERT_LE(error, bound) << random.text() << ", picture " << i << ", value " << v << "; rerun: " << rerun(seed);
        if (bound > 0.0) worst = std::max(worst, error / bound);
      }
    }
  }
  std::printf("largest share of the bound: %.3f\n", worst);
}

// Two functions in a picture, other pictures than integrals, and large ones are a device's.
TEST(OnePass, LeavesTheRestToDevices) {
  const RandomCase random(1);
  MemoryCapture capture = random.encode();
  const Shape& shape = random.capture.shape;
  const FunctionSet functions{{0, GainFunction::boxcar(0, 1000)}, {1, GainFunction::boxcar(0, 2000)}};
  Mask mask = Mask::uniform(shape.width, shape.height, 0);
  EXPECT_FALSE(suits_one_pass(make_plan(capture, functions, mask, {.combine = Combine::lighten})));
  mask.tags.front() = 1;
  EXPECT_FALSE(suits_one_pass(make_plan(capture, functions, mask, {})));
}

TEST(OnePass, IsStopped) {
  const RandomCase random(1);
  MemoryCapture capture = random.encode();
  const Shape& shape = random.capture.shape;
  const RenderPlan plan = make_plan(capture, {{0, GainFunction::boxcar(0, random.timeline.duration_ns())}},
                                    Mask::uniform(shape.width, shape.height, 0), {});
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)expose_in_one_pass({&plan, 1}, capture, Rectangle::whole(shape), {.stop = stop.get_token()}),
               Cancelled);
}

}  // namespace
}  // namespace nutik::test
