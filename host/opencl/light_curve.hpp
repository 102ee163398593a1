// Transfer functions as a straight toe and a polynomial: how kernels in single precision turn codes
// into light without a table (kernels/light.clh). Looking each code up costs a CPU twice as much.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "capture/transfer.hpp"

namespace nutik {

// light(c) = c <= toe_end ? c · toe_slope : Σ a_j t^j, t = (c - centre) · step
//
// centre is whole and step a power of two, so that t is exact in single precision. Light then errs
// by less than 3.3e-7 for every white code up to 65535, and by less than 1.7e-7 where white has
// the form 2^b - 1, b = 8 … 16 (derivation and measurement: docs/explanation/accuracy.md).
inline constexpr std::uint32_t kCurveDegree = 10;

// The curve as the kernel reads it: centre, step, toe_end, toe_slope, a_0 … a_10. Nothing where the
// transfer function has no such form: pure powers have no toe, no polynomial follows them to 0.
[[nodiscard]] std::optional<std::vector<double>> light_curve(const Transfer& transfer,
                                                             std::uint32_t white_code);

}  // namespace nutik
