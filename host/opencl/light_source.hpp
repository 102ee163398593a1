// How a kernel turns a capture's codes into light (kernels/light.clh).
#pragma once

#include <vector>

#include "capture/picture.hpp"
#include "opencl/opencl_renderer.hpp"

namespace nutik {

struct LightSource {
  const char* kind;            // the kernels' NUTIK_LIGHT
  std::vector<double> values;  // a table, a curve or pieces, to be rounded to the kernel's precision
};

// `permutes_pieces`: whether the kernel works on as many lanes as there are pieces, and the device's vectors
// hold them.
[[nodiscard]] LightSource light_source(const CaptureFormat& capture, Precision precision,
                                       bool permutes_pieces);

}  // namespace nutik
