#include "capture/primaries.hpp"

#include <gtest/gtest.h>

#include "capture/error.hpp"
#include "support/chromaticity.hpp"

namespace nutik::test {
namespace {

constexpr Primaries kAll[] = {Primaries::bt709,        Primaries::bt2020,       Primaries::p3,       Primaries::sgamut3,
                              Primaries::sgamut3_cine, Primaries::vgamut,       Primaries::cinema_gamut,
                              Primaries::arri_wg3,     Primaries::arri_wg4,     Primaries::dgamut,
                              Primaries::apple_wide_gamut, Primaries::adobe_rgb};

// A colour has one XYZ, in whichever primaries its light is told.
TEST(Primaries, MatricesKeepColours) {
  for (const Primaries primaries : kAll) {
    const ColourMatrix& matrix = to_bt709(primaries);
    const Matrix from = to_xyz(chromaticities(primaries));
    const Matrix to = to_xyz(chromaticities(Primaries::bt709));
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        const double converted = to[i][0] * matrix[0][j] + to[i][1] * matrix[1][j] + to[i][2] * matrix[2][j];
        EXPECT_NEAR(converted, from[i][j], 1e-14) << to_text(primaries) << i << j;
      }
    }
  }
}

// As the Academy's ACEScg to BT.709 with Bradford's adaptation is printed by OpenColorIO's and others' tables.
TEST(Primaries, OfAp1HaveTheirWhiteAdapted) {
  const double printed[3][3] = {
      {1.70505, -0.62179, -0.08326}, {-0.13026, 1.14080, -0.01055}, {-0.02400, -0.12897, 1.15297}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(to_bt709(Primaries::ap1)[i][j], printed[i][j], 5.1e-6);
  }
  EXPECT_EQ(parse_primaries("ap1"), Primaries::ap1);
}

// By the chromaticities of the Academy's ST 2065-1 and SMPTE's RP 431-2, in numpy.
TEST(Primaries, OfAp0AndCinemasHaveTheirWhiteAdapted) {
  const ColourMatrix ap0{{{2.521686186743882, -1.134130988239719, -0.387555198504164},
                          {-0.276479914229922, 1.372719087668256, -0.096239173438334},
                          {-0.015378064966034, -0.152975335867399, 1.168353400833433}}};
  const ColourMatrix cinemas{{{1.157516406199759, -0.154962378073858, -0.002554028125901},
                              {-0.041500071530686, 1.045567923079699, -0.004067851549013},
                              {-0.018050038956254, -0.078578272653029, 1.096628311609283}}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_NEAR(to_bt709(Primaries::ap0)[i][j], ap0[i][j], 1e-14);
      EXPECT_NEAR(to_bt709(Primaries::dci_p3)[i][j], cinemas[i][j], 1e-14);
    }
  }
}

// As ITU-R BT.2087 prints it.
TEST(Primaries, OfBt2020AreThoseOfTheStandard) {
  const double printed[3][3] = {
      {1.6605, -0.5876, -0.0728}, {-0.1246, 1.1329, -0.0083}, {-0.0182, -0.1006, 1.1187}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_NEAR(to_bt709(Primaries::bt2020)[i][j], printed[i][j], 5.1e-5);
    }
  }
}

TEST(Primaries, ReadTheirOwnText) {
  for (const Primaries primaries : kAll) EXPECT_EQ(parse_primaries(to_text(primaries)), primaries);
  EXPECT_THROW(static_cast<void>(parse_primaries("bt601")), UsageError);
}

}  // namespace
}  // namespace nutik::test
