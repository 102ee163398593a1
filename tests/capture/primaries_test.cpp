#include "capture/primaries.hpp"

#include <gtest/gtest.h>

#include "capture/error.hpp"
#include "support/chromaticity.hpp"

namespace nutik::test {
namespace {

constexpr Primaries kAll[] = {Primaries::bt709,        Primaries::bt2020,       Primaries::p3,       Primaries::sgamut3,
                              Primaries::sgamut3_cine, Primaries::vgamut,       Primaries::cinema_gamut,
                              Primaries::arri_wg3,     Primaries::arri_wg4,     Primaries::dgamut,
                              Primaries::apple_wide_gamut};

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
