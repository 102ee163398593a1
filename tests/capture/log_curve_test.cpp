// Cameras' curves against what their makers printed: code values of tables, and formulas in the makers' own words.
#include "capture/log_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>

#include "capture/transfer.hpp"

namespace nutik {
namespace {

const LogCurve& curve(std::string_view name) {
  for (const LogCurve& each : log_curves()) {
    if (each.name == name) return each;
  }
  throw std::out_of_range(std::string(name));
}

// Codes of 10 bits for reflectances, as the papers' tables have them.
struct Printed {
  std::string_view curve;
  double light;
  int code;
};

constexpr Printed kPrinted[] = {
    {"slog2", 0.0, 90},   {"slog2", 0.18, 347}, {"slog2", 0.90, 582}, {"slog3", 0.0, 95},
    {"slog3", 0.18, 420}, {"slog3", 0.90, 598}, {"vlog", 0.0, 128},   {"vlog", 0.18, 433},
    {"vlog", 0.90, 602},  {"flog", 0.0, 95},    {"flog", 0.18, 470},  {"flog", 0.90, 705},
    {"flog2", 0.0, 95},   {"flog2", 0.18, 400}, {"flog2", 0.90, 570}, {"clog3", 0.0, 128},
    {"clog3", 0.18, 351},
};

TEST(LogCurve, HasTheCodesOfItsMakersTable) {
  for (const auto& [name, light, code] : kPrinted) {
    EXPECT_EQ(std::lround(1023 * curve(name).signal_of(light)), code) << name << " " << light;
    // Within half a code, to which papers round.
    EXPECT_LE(curve(name).light_of((code - 0.5) / 1023), light + 1e-9) << name;
    EXPECT_GE(curve(name).light_of((code + 0.5) / 1023), light - 1e-9) << name;
  }
}

// A grey card's signal in the papers that print no codes.
TEST(LogCurve, HasTheGreyOfItsMakersPaper) {
  const std::map<std::string_view, double> printed{
      {"logc3", 0.391007}, {"logc4", 0.278396},    {"clog2", 0.398255},  {"nlog", 0.363668},
      {"dlog", 0.398764},  {"applelog", 0.488272}, {"acescct", 0.413588}};
  for (const auto& [name, signal] : printed) {
    EXPECT_NEAR(curve(name).signal_of(0.18), signal, 6e-7) << name;
    EXPECT_NEAR(curve(name).light_of(signal), 0.18, 3e-6) << name;
  }
}

// Formulas as printed, from signal to light.
TEST(LogCurve, IsItsMakersFormula) {
  const auto p10 = [](double x) { return std::pow(10.0, x); };
  const std::map<std::string_view, std::function<double(double)>> formulas{
      {"slog2",
       [&](double p) {
         const double y = (p * 1023 - 64) / 876;
         return 0.9 * 219 / 155 *
                (y >= 0.030001222851889303 ? p10((y - 0.616596 - 0.03) / 0.432699) - 0.037584
                                           : (y - 0.030001222851889303) / 5);
       }},
      {"slog3",
       [&](double p) {
         return p >= 171.2102946929 / 1023 ? p10((p * 1023 - 420) / 261.5) * (0.18 + 0.01) - 0.01
                                           : (p * 1023 - 95) * 0.01125 / (171.2102946929 - 95);
       }},
      {"vlog",
       [&](double p) { return p < 0.181 ? (p - 0.125) / 5.6 : p10((p - 0.598206) / 0.241514) - 0.00873; }},
      {"clog2", [&](double p) { return 0.9 * (p10((p - 0.092864125) / 0.24136077) - 1) / 87.099375; }},
      {"clog3",
       [&](double p) {
         return 0.9 * (p <= 0.15277891 ? (p - 0.12512219) / 1.9754798
                                       : (p10((p - 0.12240537) / 0.36726845) - 1) / 14.98325);
       }},
      {"logc3",
       [&](double p) {
         return p > 5.367655 * 0.010591 + 0.092809 ? (p10((p - 0.385537) / 0.247190) - 0.052272) / 5.555556
                                                   : (p - 0.092809) / 5.367655;
       }},
      {"logc4",
       [](double p) {
         const double a = (std::exp2(18) - 16) / 117.45, b = (1023.0 - 95) / 1023, c = 95.0 / 1023;
         return (std::exp2(14 * (p - c) / b + 6) - 64) / a;
       }},
      {"flog",
       [&](double p) {
         return p < 0.100537775223865 ? (p - 0.092864) / 8.735631
                                      : p10((p - 0.790453) / 0.344676) / 0.555556 - 0.009468 / 0.555556;
       }},
      {"flog2",
       [&](double p) {
         return p < 0.100686685370811 ? (p - 0.092864) / 8.799461
                                      : p10((p - 0.384316) / 0.245281) / 5.555556 - 0.064829 / 5.555556;
       }},
      {"nlog",
       [](double p) {
         return p * 1023 < 452 ? std::pow(p * 1023 / 650, 3) - 0.0075 : std::exp((p * 1023 - 619) / 150);
       }},
      {"dlog",
       [&](double p) {
         return p <= 0.14 ? (p - 0.0929) / 6.025 : (p10(3.89616 * p - 2.27752) - 0.0108) / 0.9892;
       }},
      {"applelog",
       [](double p) {
         const double r0 = -0.05641088, sigma = 47.28711236;
         return p >= sigma * (0.01 - r0) * (0.01 - r0) ? std::exp2((p - 0.69336945) / 0.08550479) - 0.00964052
                                                       : std::sqrt(p / sigma) + r0;
       }},
      {"acescct",
       [](double p) {
         return p > 0.155251141552511 ? std::exp2(p * 17.52 - 9.72)
                                      : (p - 0.0729055341958355) / 10.5402377416545;
       }},
  };
  ASSERT_EQ(formulas.size(), log_curves().size());
  for (const LogCurve& each : log_curves()) {
    const auto& formula = formulas.at(each.name);
    // Papers round the constants of the two ways differently, and N-Log's pieces overlap by a seventh of a code.
    const double codes = each.name == "nlog" ? 0.14 : 0.01;
    for (double signal = each.signal_of(0.0); signal <= 1.0; signal += 1.0 / 4093) {
      const double light = each.light_of(signal);
      EXPECT_GE(light, formula(signal - codes / 1023) - 1e-12) << each.name << " " << signal;
      EXPECT_LE(light, formula(signal + codes / 1023) + 1e-12) << each.name << " " << signal;
      EXPECT_NEAR(each.signal_of(light), signal, 2e-5) << each.name;
    }
  }
}

// In video of limited range whole codes count: Sony's grey has code 420 there, too, and ARRI's is scaled with black and
// white.
TEST(LogCurve, OfVideoCountsAsItsMakerDoes) {
  const auto reflectance = [](const Transfer& transfer, double share) {
    return transfer.light_of(share) / transfer.reference_white();
  };
  const Transfer sony = Transfer::log("slog3");
  EXPECT_NEAR(reflectance(sony, 420 / 1023.0), 0.18, 1e-6);
  EXPECT_NEAR(reflectance(sony.scaled_from_video(), (420 - 64) / 876.0), 0.18, 1e-6);
  EXPECT_EQ(sony.scaled_from_video().text(), "slog3:video");
  const Transfer arri = Transfer::log("logc3").scaled_from_video();
  EXPECT_EQ(arri.text(), "logc3");
  EXPECT_NEAR(reflectance(arri, 0.391007), 0.18, 1e-5);
  EXPECT_EQ(Transfer::srgb().scaled_from_video(), Transfer::srgb());
}

}  // namespace
}  // namespace nutik
