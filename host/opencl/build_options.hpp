// The build-time constants of the kernels for one picture.
//
//   in:      how and from what a picture is computed
//   out:     all that the kernels need: one that is missing stops their build (#error)
#pragma once

#include <string>

#include "opencl/work_shape.hpp"
#include "render/output_format.hpp"
#include "render/precision.hpp"

namespace nutik {

// How one picture is computed.
struct Work {
  Precision precision;
  WorkShape shape;
  bool has_fma;  // in the reals of the precision
};

// `-D NAME=value …` for kernels/expose.cl and combine.cl, and for develop.cl.
//
// `has_delays`: where pixels have delays, so that there may be more functions than a byte counts.
[[nodiscard]] std::string expose_options(const Work& work, const CaptureFormat& capture, const char* light_kind,
                                         bool has_delays, bool has_byte_tables = false);
// `blends`: where functions share pixels.
[[nodiscard]] std::string develop_options(const Work& work, const CaptureFormat& capture, const OutputFormat& output,
                                          bool blends, bool has_delays);

}  // namespace nutik
