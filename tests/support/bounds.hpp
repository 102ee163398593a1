// Every numeric bound that the tests use. None is tuned: docs/accuracy.md derives each of them.
// u is the unit roundoff of the arithmetic, S = ∫|g| / D.
#pragma once

#include <cstdint>

#include "capture/transfer.hpp"

namespace nutik::test {

inline constexpr double kRoundoff64 = 0x1p-53;
inline constexpr double kRoundoff32 = 0x1p-24;

// A packed weight against its exact value, in u of ∫ĝφ/D, ĝ being the line between |g| at the ends
// of each piece: gain 3 (and 2 at an end cut by the domain), hat 1, closed form 5, compensated sum
// 1, division by D 1. A boundary rounds once more. ∫ĝ <= 2 ∫|g|.
inline constexpr double kWeightRoundings = 13;

// The reference against exact arithmetic on the same light, in u of S: gains 8 (and 4 where ends
// are cut), light 4, closed form 12, compensated sum 1, division by D 1.
inline constexpr double kReferenceRoundings = 30;

// OpenCL in double against the reference, in S: what the program promises. The arithmetic keeps it
// while 2 · (samples in a block) + blocks stay below 8900.
inline constexpr double kDoubleAgainstReference = 1e-12;

// Light of a code in single precision by a fitted curve: derived for any white code, enumerated for
// whites of 2^b - 1, b = 8 … 16; whether or not the device fuses multiplication and addition.
inline constexpr double kCurveLight = 3.3e-7;
inline constexpr double kCurveLightOfUsualWhites = 1.7e-7;

// What single precision adds to the light of a code, beside roundings of the last place.
inline double single_light_error(const Transfer& transfer) {
  const bool has_curve = transfer.kind() == Transfer::Kind::srgb || transfer.kind() == Transfer::Kind::bt709;
  return has_curve ? kCurveLight : 0.0;
}

// OpenCL in arithmetic with unit roundoff u against the reference, in S, for an exposure of
// `blocks` blocks of at most `block_samples` samples: sums round n + blocks - 1 times, weights 1,
// tables n, light or its scale 2; then what the packed weights and the reference err by.
inline double kernel_against_reference(double roundoff, std::uint64_t block_samples, std::uint64_t blocks,
                                       double light_error) {
  const double errors = roundoff * static_cast<double>(2 * block_samples + blocks + 2);
  return errors / (1 - errors) + light_error + (2 * kWeightRoundings + kReferenceRoundings + 1) * kRoundoff64;
}

}  // namespace nutik::test
