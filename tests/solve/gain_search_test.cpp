// Wishes that are known to be possible, for they are the light of exposures by the reference.
#include "solve/gain_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "render/reference_renderer.hpp"
#include "support/one_pixel.hpp"
#include "support/random_case.hpp"
#include "support/watched_capture.hpp"

namespace nutik::test {
namespace {

using Kind = LightWish::Kind;

Picture exposed(CaptureSource& capture, const FunctionSet& functions, const Mask& mask) {
  const RenderPlan plan = make_plan(capture, functions, mask, {.unmapped_is_zero = true});
  OutputFormat light;
  light.type = ValueType::light64;
  return ReferenceRenderer().render(plan, capture, light).picture;
}

SampleRange all_of(const CaptureSource& capture) { return {0, capture.timeline().sample_count()}; }

// The whole picture, a part of it, and each of the mask's values.
std::vector<LightRegion> regions_of_case(const RandomCase& random) {
  std::vector<LightRegion> regions(2);
  regions[1].within =
      Rectangle{0, 0, (random.capture.shape.width + 1) / 2, (random.capture.shape.height + 1) / 2};
  for (const MaskRegion& region : regions_of(random.mask)) {
    LightRegion& added = regions.emplace_back();
    added.tag = region.tag;
  }
  return regions;
}

// A problem whose functions are those of a case, with a name in place of every gain but 0, one for each that differs.
struct Constructed {
  WishedExposure wished;
  std::vector<double> gains;
};

Constructed with_names(const RandomCase& random, std::vector<RegionLight> regions) {
  Constructed constructed;
  WishedExposure& wished = constructed.wished;
  wished.duration_ns = random.timeline.duration_ns();
  wished.channels = random.capture.shape.channels;
  wished.luminance = wished.channels == 1 ? ChannelLight{1.0} : ChannelLight{0.25, 0.5, 0.25};
  for (const auto& [tag, function] : random.functions) {
    for (const RegionLight& region : regions) {
      if (!region.courses.contains(tag) || wished.functions.contains(tag)) continue;
      for (const ControlPoint& point : function.points()) {
        TemplatePoint named{point.time_ns, 0.0, std::nullopt, std::nullopt};
        if (point.gain != 0.0) {
          named.gain_name = constructed.gains.size();
          constructed.gains.push_back(point.gain);
        }
        wished.functions[tag].push_back(named);
      }
    }
  }
  wished.bounds.resize(constructed.gains.size());
  wished.regions = std::move(regions);
  return constructed;
}

TEST(RegionLight, ComesToTheLightOfAnExposure) {
  double worst = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const RandomCase random(seed);
    MemoryCapture capture = random.encode();
    const std::vector<LightRegion> regions = regions_of_case(random);
    const Picture picture = exposed(capture, random.functions, random.mask);
    const std::vector<RegionLight> measured = measure_regions(capture, random.capture.transfer, random.mask,
                                                              nullptr, regions, nullptr, all_of(capture));
    const RegionPixels pixels(random.mask, nullptr);
    for (std::size_t i = 0; i < regions.size(); ++i) {
      const ChannelLight wanted = mean_light(picture, pixels, regions[i]);
      ChannelLight light{};
      double scale = 0;
      for (const auto& [tag, course] : measured[i].courses) {
        const auto function = random.functions.find(tag);
        if (function == random.functions.end()) continue;
        const GainSummary summary = summarize(function->second, random.timeline.duration_ns());
        if (summary.support_ns == 0) continue;
        const auto pieces = function->second.pieces(random.timeline.duration_ns());
        const ChannelLight integral = course.integral_ns(pieces);
        for (std::size_t channel = 0; channel < 3; ++channel)
          light[channel] += integral[channel] / static_cast<double>(summary.support_ns);
        scale = std::max(scale, summary.error_scale());
      }
      for (std::uint32_t channel = 0; channel < random.capture.shape.channels; ++channel) {
        const double error = std::fabs(light[channel] - wanted[channel]);
        ASSERT_LE(error, 1e-12 * std::max(scale, 1e-300)) << seed << ": region " << i;
        if (scale > 0) worst = std::max(worst, error / scale);
      }
    }
  }
  std::cout << "worst: " << worst << " S\n";
}

TEST(RegionLight, TakesOneLookAtEachBlock) {
  const RandomCase random(7);
  MemoryCapture encoded = random.encode();
  std::vector<int> lent(encoded.block_count());
  WatchedCapture capture(encoded, [&](std::uint64_t block) { ++lent[block]; });
  static_cast<void>(measure_regions(capture, random.capture.transfer, random.mask, nullptr,
                                    regions_of_case(random), nullptr, all_of(capture)));
  for (const int times : lent) EXPECT_EQ(times, 1);
}

TEST(GainSearch, ReachesConstructedWishes) {
  double worst = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const RandomCase random(seed);
    MemoryCapture encoded = random.encode();
    std::vector<int> lent(encoded.block_count());
    WatchedCapture capture(encoded, [&](std::uint64_t block) { ++lent[block]; });
    const std::vector<LightRegion> regions = regions_of_case(random);
    const Picture picture = exposed(capture, random.functions, random.mask);
    std::ranges::fill(lent, 0);
    Constructed constructed =
        with_names(random, measure_regions(capture, random.capture.transfer, random.mask, nullptr, regions,
                                           nullptr, all_of(capture)));
    const RegionPixels pixels(random.mask, nullptr);
    double largest = 0;
    for (std::size_t i = 0; i < regions.size(); ++i) {
      LightWish wish;
      wish.region = i;
      wish.kind = Kind::like;
      wish.target = mean_light(picture, pixels, regions[i]);
      for (const double each : std::get<ChannelLight>(wish.target))
        largest = std::max(largest, std::fabs(each));
      constructed.wished.wishes.push_back(wish);
    }
    GainSearch search(constructed.wished);
    const auto found = search.find({});
    ASSERT_TRUE(found) << seed;
    for (const int times : lent) ASSERT_EQ(times, 1) << "no candidate takes another look";

    // By an exposure with what was found.
    FunctionSet functions = random.functions;
    for (const auto& [tag, points] : constructed.wished.functions) {
      std::vector<ControlPoint> control;
      for (const TemplatePoint& point : points)
        control.push_back({point.time_ns, point.gain_name ? found->gains[*point.gain_name] : 0.0});
      functions.insert_or_assign(tag, GainFunction(control));
    }
    const Picture reached = exposed(capture, functions, random.mask);
    for (std::size_t i = 0; i < regions.size(); ++i) {
      const ChannelLight light = mean_light(reached, pixels, regions[i]);
      const auto& wanted = std::get<ChannelLight>(constructed.wished.wishes[i].target);
      for (std::size_t channel = 0; channel < 3; ++channel) {
        const double error = std::fabs(light[channel] - wanted[channel]);
        ASSERT_LE(error, 1e-6 * std::max(1.0, largest)) << seed << ": region " << i;
        worst = std::max(worst, error / std::max(1.0, largest));
      }
    }
  }
  std::cout << "worst: " << worst << "\n";
}

// 20 ms of gain a, then 20 ms of gain b.
constexpr const char* kTwoBoxes = "M0 [0:a], [19999999:a], [20000000:b], [40000000:b], [40000001:0]";

TEST(GainSearch, StaysWithinBounds) {
  OnePixel pixel({0.2, 0.2, 0.6, 0.6, 0.5});
  pixel.set(kTwoBoxes);
  pixel.wished.bounds = {{0.1, 1.0}, {-2.0, 0.5}};
  pixel.wish(Kind::equal, 0.9);
  GainSearch search(pixel.wished);
  const auto found = search.find({});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->gains, (std::vector<double>{1.0, 0.5})) << "as bright as bounds allow";
  EXPECT_NEAR(found->cost, std::pow(0.9 - (0.2 * 1.0 + 0.6 * 0.5) / 2, 2), 1e-8);
}

TEST(GainSearch, LeavesAloneWhatIsWithinAWish) {
  OnePixel pixel({0.2, 0.2, 0.6, 0.6, 0.5});
  pixel.set(kTwoBoxes);
  pixel.wish(Kind::at_most, 0.7);
  pixel.wish(Kind::at_least, 0.1);
  GainSearch search(pixel.wished);
  EXPECT_EQ(search.find({})->gains, (std::vector<double>{1.0, 1.0}));
  EXPECT_EQ(search.find({})->cost, 0.0);

  pixel.wished.wishes.clear();
  pixel.wish(Kind::at_most, 0.3);
  GainSearch darker(pixel.wished);
  static_cast<void>(darker.find({}));
  EXPECT_NEAR(darker.region_light()[0][0], 0.3, 1e-12) << "no darker than it must be";
}

TEST(GainSearch, WeighsWishesThatContradict) {
  OnePixel pixel({0.2, 0.2, 0.6, 0.6, 0.5});
  pixel.set("M0 [0:a], [40000000:a], [40000001:0]");
  pixel.wish(Kind::equal, 0.2, 3.0);
  pixel.wish(Kind::equal, 0.6, 1.0);
  GainSearch search(pixel.wished);
  EXPECT_NEAR(search.find({})->cost, 3 * 0.1 * 0.1 + 0.3 * 0.3, 1e-12);
  EXPECT_NEAR(search.region_light()[0][0], 0.3, 1e-12);
}

TEST(GainSearch, TellsWhatNoWishTells) {
  OnePixel pixel({0.2, 0.2, 0.6, 0.6, 0.5});
  pixel.set(
      "M0 [0:a], [19999999:a], [20000000:b], [40000000:b], [40000001:0], [60000000:0], [90000000:c], "
      "[100000000:0]");
  pixel.wish(Kind::equal, 0.3);
  GainSearch search(pixel.wished);
  const auto found = search.find({});
  EXPECT_EQ(search.untold(), std::vector<std::size_t>{2}) << "c lies behind the capture";
  EXPECT_EQ(found->gains[2], 1.0);
  EXPECT_EQ(search.open_count(), 1u) << "one wish for a and b";
}

TEST(GainSearch, FollowsADivisorThatDependsOnGains) {
  for (const char* divisor : {"integral", "absolute", "seconds:0.02"}) {
    OnePixel pixel({0.2, 0.2, 0.6, 0.6, 0.5});
    pixel.set("M0 [0:1], [19999999:1], [20000000:b], [40000000:b], [40000001:0]");
    pixel.wished.normalization = Normalization::parse(divisor);
    pixel.wish(Kind::equal, 0.25);
    GainSearch search(pixel.wished);
    const auto found = search.find({});
    ASSERT_TRUE(found);
    EXPECT_LE(found->cost, 1e-20) << divisor;
    EXPECT_NEAR(search.region_light()[0][0], 0.25, 1e-10) << divisor;
    const double by_hand = std::string(divisor) == "seconds:0.02" ? 0.05 / 0.6 : 0.05 / 0.35;
    EXPECT_NEAR(found->gains[0], by_hand, 1e-6) << divisor;
  }
}

// A second of a scene with something at rest in the end, which the last 10 ms take away again. In the middle of the
// bounds, at -100, they take away the whole second.
TEST(GainSearch, BeginsElsewhereWhereAFunctionCancels) {
  std::vector<double> light(101, 0.2);
  for (std::size_t k = 75; k < light.size(); ++k) light[k] = 0.6;
  OnePixel pixel(light);
  pixel.set("M0{[0:1], [999999999:1], [1000000000:rest], [1009999999:rest], [1010000000:0]}");
  pixel.wished.bounds = {{-200.0, 0.0}};
  pixel.wished.normalization = Normalization::parse("integral");
  pixel.wish(Kind::equal, 0.2);
  GainSearch search(pixel.wished);
  const auto found = search.find({});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->gains[0], -25, 1e-4);
  EXPECT_LE(found->cost, 1e-20);

  // From far on the other side of where it cancels, the way down ends at a bound.
  for (const double low : {-300.0, -1000.0}) {
    pixel.wished.bounds = {{low, 0.0}};
    const auto nearer = GainSearch(pixel.wished).find({});
    ASSERT_TRUE(nearer);
    EXPECT_NEAR(nearer->gains[0], -25, 1e-4);
  }
  pixel.wished.bounds = {{-200.0, 0.0}};

  // Light that only a function that all but cancels has: what tells it is not known.
  pixel.wished.wishes.clear();
  pixel.wish(Kind::equal, 1e5);
  GainSearch brightest(pixel.wished);
  ASSERT_TRUE(brightest.find({}));
  EXPECT_NO_THROW(static_cast<void>(brightest.untold()));
  EXPECT_NO_THROW(static_cast<void>(brightest.open_count()));

  // Nothing but a function that cancels.
  pixel.wished.bounds = {{-100.0, -100.0}};
  GainSearch none(pixel.wished);
  EXPECT_THROW(static_cast<void>(none.find({})), InputError);
}

TEST(GainSearch, BeginsBetweenBoundsHoweverFarApart) {
  OnePixel pixel({0.2, 0.2, 0.6});
  pixel.set("M0 [0:a], [20000000:a], [20000001:0]");
  pixel.wished.bounds = {{-1e308, 1e308}};
  pixel.wish(Kind::equal, 0.1);
  GainSearch search(pixel.wished);
  EXPECT_NEAR(search.find({})->gains[0], 0.5, 1e-6);
}

// Three exposures of a scene in which now this, now that is missing, mixed so that all of it is missing.
TEST(GainSearch, FindsMixturesWhoseScaleCountsForNothing) {
  for (const char* divisor : {"integral", "support"}) {
    OnePixel pixel({0.2, 0.2, 0.6, 0.6, 0.6, 0.6});
    pixel.wished.regions.push_back(OnePixel({0.3, 0.3, 0.3, 0.3, 0.9, 0.9}).wished.regions[0]);
    pixel.set("M0 [0:a], [20000000:a], [20000001:b], [40000000:b], [40000001:c], [60000000:c]");
    pixel.wished.normalization = Normalization::parse(divisor);
    // b takes away from a + c what neither scene should have.
    pixel.wish(Kind::equal, 0.2);
    pixel.wish(Kind::equal, 0.9);
    pixel.wished.wishes[1].region = 1;
    GainSearch search(pixel.wished);
    const auto found = search.find({});
    ASSERT_TRUE(found);
    EXPECT_LE(found->cost, 1e-20) << divisor;
    if (std::string(divisor) == "integral") {
      EXPECT_NEAR(found->gains[0] / found->gains[2], 1, 1e-6);
      EXPECT_NEAR(found->gains[1] / found->gains[2], -1, 1e-6);
      EXPECT_EQ(search.open_count(), 0u) << "larger gains are no other answer";
    } else {
      EXPECT_EQ(search.open_count(), 1u);
    }
  }
}

TEST(GainSearch, CountsNoTimeOfAGainThatCameToNothing) {
  OnePixel pixel({0.2, 0.2, 0.6, 0.6, 0.5});
  pixel.set(kTwoBoxes);
  pixel.wished.bounds = {{}, {0.0, 1.0}};
  LightWish gone;
  gone.kind = Kind::gone;
  gone.still[0] = {0.2, 0.0, 0.0};
  pixel.wished.wishes.push_back(gone);
  pixel.wish(Kind::equal, 0.2);
  GainSearch search(pixel.wished);
  const auto found = search.find({});
  EXPECT_EQ(found->gains[1], 0.0) << "what is bright moves";
  // 20 ms are exposed, not 40, for which a would have to be 2; but for half a nanosecond of its step.
  EXPECT_NEAR(found->gains[0], 1.0, 1e-7);

  // Twice the light without b's time: too much for 0.09, to which b at next to nothing comes nearest; to 0.19 no b.
  const auto only_b = [](Bounds bounds, double light) {
    OnePixel still({0.2, 0.2, 0.2, 0.2, 0.5});
    still.set("M0 [0:1], [19999999:1], [20000000:b], [40000000:b], [40000001:0]");
    still.wished.bounds = {bounds};
    still.wish(Kind::equal, light);
    return *GainSearch(still.wished).find({});
  };
  EXPECT_EQ(only_b({0.0, 1.0}, 0.09).gains[0], kLeastGain);
  EXPECT_NEAR(only_b({0.0, 1.0}, 0.09).cost, 1e-4, 1e-9);
  EXPECT_EQ(only_b({-0.5, 0.2}, 0.19).gains[0], 0.0);
}

}  // namespace
}  // namespace nutik::test
