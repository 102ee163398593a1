// A transfer function as 16 cubic pieces: how a CPU whose vectors hold 16 floats turns codes into light
// in single precision. The pieces' coefficients stay in registers, each lane picks its own by permutation:
// 0.6 times what the curve of degree 10 takes (light_curve.hpp), 0.4 times a look-up.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "capture/transfer.hpp"

namespace nutik {

inline constexpr std::uint32_t kLightPieces = 16;

// The codes of a piece are 2^piece_bits: 16 pieces hold every code up to the white code.
[[nodiscard]] std::uint32_t piece_bits(std::uint32_t white_code);

// light(c) = c <= toe_end ? t · toe_slope : a_0[p] + a_1[p] t + a_2[p] t² + a_3[p] t³,
// p = c >> piece_bits, t = c mod 2^piece_bits
//
// As the kernel reads it: toe_end, toe_slope, then a_0[16], a_1[16], a_2[16], a_3[16]. Light errs by less than
// 2e-7 (docs/accuracy.md). Nothing where the function's toe is not within the first piece, or where the white code is
// below 255.
[[nodiscard]] std::optional<std::vector<double>> light_pieces(const Transfer& transfer,
                                                              std::uint32_t white_code);

}  // namespace nutik
