// How a kernel turns a capture's codes into light (kernels/light.clh).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "capture/picture.hpp"
#include "capture/transfer.hpp"
#include "opencl/opencl_renderer.hpp"

namespace nutik {

// A transfer function as a straight toe and 15 cubics: how a CPU whose vectors hold 16 floats turns codes
// into light in single precision. The pieces' coefficients stay in registers and each lane picks its own by
// permutation: half of what the curve of degree 10 takes (light_curve() in light_source.cpp), a third of a look-up.

inline constexpr std::uint32_t kLightPieces = 16;

// light(c) = a_0[p] + a_1[p] c + a_2[p] c² + a_3[p] c³,   p = ⌊scale · c + offset⌋
//
// Piece 0 is the toe; the others cut the rest into equal parts, half way between codes. As the kernel reads
// it: scale, offset, then a_0[16], a_1[16], a_2[16], a_3[16]. Light errs by less than 2.7e-7, measured
// 1.3e-7 (docs/explanation/accuracy.md).
// Nothing where the function has no straight toe, or where the white code is below 255.
[[nodiscard]] std::optional<std::vector<double>> light_pieces(const Transfer& transfer,
                                                              std::uint32_t white_code);

struct LightSource {
  const char* kind;            // the kernels' NUTIK_LIGHT
  std::vector<double> values;  // a table, a curve or pieces, to be rounded to the kernel's precision
  std::vector<double> bytewise = {};  // light of 256 codes, of which rows look up byte by byte; empty: they do not
};

struct LightLookup {
  bool permutes_pieces = false;   // the kernel works on as many lanes as there are pieces, and the device's vectors
                                  // hold them
  bool has_near_table = false;    // tables of 256 codes lie beside a group of work-items
  bool looks_up_bytes = false;    // the kernel fuses products and works on 64 codes in 16 lanes, and the device looks
                                  // up 64 bytes at once
};

[[nodiscard]] LightSource light_source(const CaptureFormat& capture, Precision precision, const LightLookup& means);

}  // namespace nutik
