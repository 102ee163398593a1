// Every numeric bound that the tests use, with its reason. Derived, not tuned: docs/accuracy.md has the
// derivations. u is the unit roundoff of the arithmetic, S = ∫|g| / D.
#pragma once

namespace nutik::test {

inline constexpr double kRoundoff64 = 0x1p-53;
inline constexpr double kRoundoff32 = 0x1p-24;

// A packed weight against its exact value, in u of ∫|g φ|/D over the sample's reach. Each stretch of the
// closed form costs two interpolated gains (3 roundings each), two hat values (3 each), 5 multiplications
// and 3 additions; compensated summation adds 2, division by D 1, the scaled gains 0: at most 20.
inline constexpr double kWeightRoundings = 20;

// The reference against exact arithmetic, in u of S: an interval costs two gains (4 roundings), two
// lights (4), 9 operations of the closed form; compensated summation 2, division by D and the final
// scaling 2; light itself is given. At most 24.
inline constexpr double kReferenceRoundings = 24;

// OpenCL in double against the reference, in S: the specification promises 1e-12; the arithmetic gives
// about (64 + blocks) u.
inline constexpr double kDoubleAgainstReference = 1e-12;

}  // namespace nutik::test
