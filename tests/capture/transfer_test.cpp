#include "capture/transfer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "capture/error.hpp"
#include "capture/light_codes.hpp"
#include "support/messages.hpp"

namespace nutik::test {
namespace {

const std::vector<Transfer> kAllTransfers = [] {
  std::vector<Transfer> all{Transfer::srgb(),     Transfer::bt709(), Transfer::linear(), Transfer::gamma(2.2),
                            Transfer::gamma(0.5), Transfer::hlg(),   Transfer::pq()};
  for (const LogCurve& curve : log_curves()) {
    all.push_back(Transfer::log(curve.name));
    if (curve.is_of_whole_codes) all.push_back(all.back().scaled_from_video());
  }
  return all;
}();

TEST(LightCodes, FindTheLastCodeThatBeginsNoLater) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const Transfer& transfer : kAllTransfers) {
    for (const std::uint32_t white : {1u, 100u, 255u, 4095u, 65'535u}) {
      const LightCodes codes(transfer, white);
      const std::vector<double> begins = transfer.code_thresholds(white);
      std::vector<double> lights{-kInfinity, -1, 0, 1, 1.5, kInfinity};
      for (std::size_t code = 1; code <= white; code += 1 + code / 64)
        for (const double towards : {0.0, 1.0, begins[code]}) lights.push_back(std::nextafter(begins[code], towards));
      for (const double light : lights) {
        const auto after = std::upper_bound(begins.begin() + 1, begins.end(), std::max(light, 0.0));
        ASSERT_EQ(codes.code_of(light), after - begins.begin() - 1) << transfer.text() << ' ' << white << ' ' << light;
      }
      EXPECT_EQ(codes.code_of(std::nan("")), codes.code_of(0)) << transfer.text();
    }
  }
}

// Values of the standards, from their own formulas worked out by hand.
TEST(Transfer, HasTheStandardsValues) {
  EXPECT_NEAR(Transfer::srgb().light_of(128 / 255.0), 0.21586050011389926, 1e-15);
  EXPECT_NEAR(Transfer::srgb().light_of(10 / 255.0), 0.0030352698354883752, 1e-17);
  EXPECT_NEAR(Transfer::bt709().light_of(0.5), 0.2597194371011774, 1e-15);
  EXPECT_DOUBLE_EQ(Transfer::bt709().light_of(0.045), 0.01);
  EXPECT_DOUBLE_EQ(Transfer::gamma(2.0).light_of(0.5), 0.25);
  EXPECT_EQ(Transfer::linear().light_of(0.3), 0.3);
  for (const Transfer& transfer : kAllTransfers) {
    EXPECT_EQ(transfer.light_of(0.0), 0.0) << transfer.text();
    EXPECT_DOUBLE_EQ(transfer.light_of(1.0), 1.0) << transfer.text();
  }
}

// BT.2100 prints these of its formulas, and BT.2408 table 1 where reference white lies.
TEST(Transfer, HasThoseOfHighDynamicRange) {
  const Transfer hlg = Transfer::hlg(), pq = Transfer::pq();
  EXPECT_DOUBLE_EQ(hlg.light_of(0.5), 1.0 / 12);
  EXPECT_DOUBLE_EQ(hlg.light_of(0.25), 0.25 * 0.25 / 3);
  EXPECT_NEAR(hlg.light_of(0.75), (std::exp((0.75 - 0.55991073) / 0.17883277) + 0.28466892) / 12, 1e-8);
  EXPECT_NEAR(10'000 * pq.light_of(0.5081), 100, 0.1);
  EXPECT_NEAR(10'000 * pq.light_of(0.5807), 203, 0.2);
  EXPECT_NEAR(10'000 * pq.light_of(0.7518), 1000, 1);
  EXPECT_NEAR(pq.fraction_of(0.1), 0.7518, 1e-4);
  EXPECT_DOUBLE_EQ(pq.reference_white(), 0.0203);
  EXPECT_DOUBLE_EQ(hlg.reference_white(), hlg.light_of(0.75));
  EXPECT_EQ(Transfer::srgb().reference_white(), 1.0);
  // The two pieces of HLG meet, with the same slope.
  const double step = 1e-6;
  const double below = (hlg.light_of(0.5) - hlg.light_of(0.5 - step)) / step;
  const double above = (hlg.light_of(0.5 + step) - hlg.light_of(0.5)) / step;
  EXPECT_NEAR(above / below, 1.0, 1e-5);
}

// What bounds of light take for granted: next to white, where rounding counts most, 14 units of it.
TEST(Transfer, ErrsByFewRoundings) {
  const std::pair<std::pair<const char*, int>, double> exact[]{
      {{"pq", 64491}, 0.859200194631876885211},      {{"pq", 65307}, 0.967327963411786312206},
      {{"hlg", 64522}, 0.919159626113872243602},     {{"logc4", 64557}, 0.852440047349006342326},
      {{"acescct", 64524}, 0.829159306080818448284}, {{"clog2:video", 64564}, 0.885956747830794947352},
      {{"slog3:video", 65343}, 0.977643034127646444858}};
  for (const auto& [of, light] : exact)
    EXPECT_NEAR(Transfer::parse(of.first).light_of(of.second / 65535.0), light, 14 * 0x1p-53 * light) << of.first;
}

// What bounds of codes take for granted (render/error_bound.hpp): that nowhere do codes change more with light than at
// one end.
TEST(Transfer, ChangesMostAtAnEnd) {
  for (const Transfer& transfer : kAllTransfers) {
    for (double change = 1e-15; change < 0.9; change *= 1.5) {
      const double most = std::max(transfer.fraction_of(change), 1 - transfer.fraction_of(1 - change));
      for (double low = 1e-15; low < 1 - change; low *= 1.2) {
        const double step = transfer.fraction_of(low + change) - transfer.fraction_of(low);
        ASSERT_LE(step, most * (1 + 1e-9) + 1e-15) << transfer.text() << " at " << low << ", " << change;
      }
    }
  }
}

// So does a function that bends one way only. Of cameras' curves some bend more than once: the lights of Apple's toe
// follow a square root, and two pieces of Nikon's meet at an angle.
TEST(Transfer, BendsOneWay) {
  for (const Transfer& transfer : kAllTransfers) {
    if (transfer.kind() == Transfer::Kind::log) continue;
    const bool bends_down = transfer.fraction_of(0.25) > 0.25;
    if (transfer.is_linear()) continue;
    double last = bends_down ? HUGE_VAL : 0.0;
    for (double low = 1e-15; low < 0.9; low *= 1.05) {
      const double high = low * 1.05;
      const double slope = (transfer.fraction_of(high) - transfer.fraction_of(low)) / (high - low);
      EXPECT_TRUE(bends_down ? slope <= last * (1 + 1e-9) : slope >= last * (1 - 1e-9))
          << transfer.text() << " at " << low;
      last = slope;
    }
  }
}

TEST(Transfer, GivesEveryCodeBack) {
  for (const Transfer& transfer : kAllTransfers) {
    for (const std::uint32_t white : {255u, 1023u, 4095u, 65'535u}) {
      for (std::uint32_t code = 0; code <= white; ++code) {
        const double light = transfer.light_of(static_cast<double>(code) / white);
        const double back = std::floor(transfer.fraction_of(light) * white + 0.5);
        ASSERT_EQ(back, code) << transfer.text() << ", white " << white;
      }
    }
  }
}

// A code's threshold separates it from the one below: light on either side rounds to either code.
TEST(Transfer, ThresholdsLieBetweenCodes) {
  for (const Transfer& transfer : kAllTransfers) {
    const auto light = transfer.light_of_codes(255);
    const auto thresholds = transfer.code_thresholds(255);
    ASSERT_EQ(thresholds.size(), 256u);
    EXPECT_EQ(thresholds[0], 0.0);
    for (std::size_t code = 1; code < 256; ++code) {
      EXPECT_LT(light[code - 1], thresholds[code]) << transfer.text();
      EXPECT_GT(light[code], thresholds[code]) << transfer.text();
    }
  }
}

TEST(Transfer, ReadsItsOwnText) {
  for (const Transfer& transfer : kAllTransfers) EXPECT_EQ(Transfer::parse(transfer.text()), transfer);
}

TEST(Transfer, RefusesOthersByName) {
  for (const char* text : {"", "sRGB", "gamma", "gamma:", "gamma:2.2x", "gamma:0", "gamma:11", "gamma:nan"}) {
    SCOPED_TRACE(text);
    expect_error<UsageError>([&] { return Transfer::parse(text); }, {"gamma:"});
  }
}

}  // namespace
}  // namespace nutik::test
