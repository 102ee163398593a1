// What every renderer offers: a plan and the capture it was made for in, a picture out.
#pragma once

#include <cstdint>
#include <string>

#include "capture/picture.hpp"
#include "imev/capture_source.hpp"
#include "render/render_plan.hpp"

namespace nutik {

// What codes say of light below 0. saturate: code 0; offset: light 0 has the middle code, each sign half of
// the codes; absolute: as much light above 0.
enum class NegativeLight { saturate, offset, absolute };

// How a picture's values are to be stored. Codes are made with the capture's transfer function and
// saturate at 0 and at the white code; light is kept as it is.
struct OutputFormat {
  ValueType type = ValueType::code8;
  std::uint32_t white_code = 255;
  NegativeLight negative = NegativeLight::saturate;  // of codes
};

// How many pixels hold light that no code was left for (render/code_scale.hpp).
struct Saturation {
  std::uint64_t below = 0;
  std::uint64_t above = 0;

  Saturation& operator+=(const Saturation& other) {
    below += other.below;
    above += other.above;
    return *this;
  }
  friend bool operator==(const Saturation&, const Saturation&) = default;
};

class Renderer {
 public:
  virtual ~Renderer() = default;

  // Blocks of this capture stay where they are rendered from once they have been read, as far as memory
  // allows, so that the next picture of it needs not read them again. Until another is held; null: none. The
  // capture must live that long. A renderer may do without.
  virtual void hold(const CaptureSource* /*source*/) {}

  // Does ahead what render() needs no capture for, kernels to load for example. May be left out.
  virtual void prepare(const RenderPlan& /*plan*/, const OutputFormat& /*output*/) {}

  // Exposes a picture. `source` is the capture that the plan was made for; its blocks are read in time
  // order. Throws InputError for a damaged block, DeviceError where the device fails.
  [[nodiscard]] virtual Picture render(const RenderPlan& plan, CaptureSource& source,
                                       const OutputFormat& output) = 0;

  // Of the last render; none where it kept light.
  [[nodiscard]] virtual Saturation saturation() const = 0;

  // What does the work, as a person would call it: a device's name, "scalar reference".
  [[nodiscard]] virtual std::string name() const = 0;

  // The arithmetic of the last render, by the name that asks for it: `double`, `single`.
  [[nodiscard]] virtual std::string precision() const = 0;

  // What the last render did and took, in lines for a person; empty where there is nothing to say.
  [[nodiscard]] virtual std::string report() const { return {}; }

  // What is doubtful about the last picture, a whole sentence; empty where nothing is.
  [[nodiscard]] virtual std::string warning() const { return {}; }
};

}  // namespace nutik
