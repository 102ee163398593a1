// What every renderer offers: a plan and the capture it was made for in, a picture out.
#pragma once

#include <cstdint>
#include <string>

#include "capture/picture.hpp"
#include "imev/capture_source.hpp"
#include "render/render_plan.hpp"

namespace nutik {

// How a picture's values are to be stored. Codes are made with the capture's transfer function and
// saturate at 0 and at the white code; light is kept as it is.
struct OutputFormat {
  ValueType type = ValueType::code8;
  std::uint32_t white_code = 255;
};

class Renderer {
 public:
  virtual ~Renderer() = default;

  // Does ahead what render() needs no capture for, kernels to load for example. May be left out.
  virtual void prepare(const RenderPlan& /*plan*/, const OutputFormat& /*output*/) {}

  // Exposes a picture. `source` is the capture that the plan was made for; its blocks are read in time
  // order. Throws InputError for a damaged block, DeviceError where the device fails.
  [[nodiscard]] virtual Picture render(const RenderPlan& plan, CaptureSource& source,
                                       const OutputFormat& output) = 0;

  // What does the work, as a person would call it: a device's name, "scalar reference".
  [[nodiscard]] virtual std::string name() const = 0;

  // The arithmetic of the last render, by the name that asks for it: `double`, `single`.
  [[nodiscard]] virtual std::string precision() const = 0;

  // What the last render did and took, in a line for a person; empty where there is nothing to say.
  [[nodiscard]] virtual std::string report() const { return {}; }
};

}  // namespace nutik
