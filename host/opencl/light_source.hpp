// How a kernel turns a capture's codes into light (kernels/light.clh).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "capture/picture.hpp"
#include "capture/transfer.hpp"
#include "render/precision.hpp"

namespace nutik {

// A transfer function as a straight toe and 15 cubics: how a CPU whose vectors hold 16 floats turns codes
// into light in single precision. The pieces' coefficients stay in registers and each lane picks its own by
// permutation: half of what the curve of degree 10 takes (light_curve() in light_source.cpp), a third of a look-up.

inline constexpr std::uint32_t kLightPieces = 16;

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
