// Every numeric bound that the tests use beside those that the program computes itself
// (render/error_bound.hpp). None is tuned: docs/explanation/accuracy.md derives each of them.
// u is the unit roundoff of the arithmetic, S = ∫|g| / D.
#pragma once

#include <algorithm>
#include <cstdio>
#include <vector>

namespace nutik::test {

inline constexpr double kRoundoff64 = 0x1p-53;

// A packed weight against its exact value, in u of ∫ĝφ/D, ĝ being the line between |g| at the ends
// of each piece: gain 3 (and 2 at an end cut by the domain), hat 1, closed form 5, compensated sum
// 1, division by D 1. A boundary rounds once more. ∫ĝ <= 2 ∫|g|.
inline constexpr double kWeightRoundings = 13;

// The reference against exact arithmetic on the same light, in u of S: gains 8 (and 4 where ends
// are cut), light 4, closed form 12, compensated sum 1, division by D 1.
inline constexpr double kReferenceRoundings = 30;

// OpenCL in double against the reference, in S: what the program promises of exposures that are not extremely
// long (docs/explanation/accuracy.md).
inline constexpr double kDoubleAgainstReference = 1e-12;

// Light of a code in single precision by a fitted curve: enumerated for whites of 2^b - 1, b = 8 … 16; whether
// or not the device fuses multiplication and addition.
inline constexpr double kCurveLightOfCommonWhites = 1.7e-7;

// Says how much of their bound cases used, of which there is one at least. Returns the median.
inline double print_shares(const char* what, std::vector<double> shares) {
  std::ranges::sort(shares);
  const double median = shares[shares.size() / 2];
  std::printf("%-32s %zu cases, share of the bound: median %.3g, most %.3g\n", what, shares.size(), median, shares.back());
  return median;
}

}  // namespace nutik::test
