// Develops a picture: the sums of its bands to codes or light, with kernels/develop.cl.
//
//   in:      a plan, a rectangle of its picture, and the sums of its exposure, band after band
//   out:     the rectangle's picture; of codes also how many pixels saturate
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "opencl/allocation_cuts.hpp"
#include "opencl/build_options.hpp"
#include "opencl/device_lookups.hpp"
#include "opencl/device_memory.hpp"
#include "opencl/opencl_api.hpp"
#include "render/code_scale.hpp"
#include "render/renderer.hpp"

namespace nutik {

// A band on the device.
struct ExposedBand {
  Band band;
  DeviceMap map;
  cl::Buffer sums;  // Σ_k v_k w_k of every pixel, tile by tile as in the map; none until the band is exposed
  cl::Buffer bundles;  // likewise, of the bundle that is being added up, where there are any
};

class Developer {
 public:
  // `program` is kernels/develop.cl built for the picture: with blending if the plan's mask is soft. All that is given
  // must live as long.
  Developer(const Work& work, const RenderPlan& plan, const OutputFormat& output, const Rectangle& rectangle,
            cl::Program program, cl::CommandQueue queue, DeviceLookups& lookups, DeviceMemory& memory)
      : work_(work),
        plan_(plan),
        output_(output),
        rectangle_(rectangle),
        shape_{rectangle.width, rectangle.height, plan.capture.shape.channels},
        program_(std::move(program)),
        queue_(std::move(queue)),
        lookups_(lookups),
        memory_(memory),
        picture_(shape_, output.type, output.white_code) {}

  // Each band once, in any order.
  void develop(const ExposedBand& exposed);

  // When all bands have been developed.
  [[nodiscard]] Picture take_picture() { return std::move(picture_); }
  [[nodiscard]] const Saturation& saturation() const { return saturation_; }
  // What the kernels took, by the device's own clock.
  [[nodiscard]] double develop_ms() const { return develop_ms_; }

 private:
  void make_counted_codes(const ExposedBand& exposed);
  void make_codes(const ExposedBand& exposed, const DeviceCodes& tables);
  [[nodiscard]] Saturation saturated(const ExposedBand& exposed, const CodeScale& scale);
  template <typename Visit>
  void for_each_part(const ExposedBand& exposed, ValueType type, Visit visit);
  void develop_rows(const ExposedBand& exposed, const Band& rows, const Rectangle& part, Picture& picture);
  void blend_rows(const ExposedBand& exposed, const Band& rows, const Rectangle& part, Picture& picture);
  [[nodiscard]] std::span<std::byte> rows_of(const Rectangle& part);
  [[nodiscard]] Rectangle part_in(const Band& band) const;
  template <typename Launch>
  void develop_band(const Band& band, const Rectangle& part, std::span<std::byte> raster, Launch launch);
  void read_band(const cl::Buffer& of_band, const Band& band, const Rectangle& part,
                 std::span<std::byte> raster);

  const Work& work_;
  const RenderPlan& plan_;
  const OutputFormat& output_;
  const Rectangle& rectangle_;
  Shape shape_;  // of what is developed
  cl::Program program_;
  cl::CommandQueue queue_;
  DeviceLookups& lookups_;
  DeviceMemory& memory_;
  Picture picture_;
  Saturation saturation_;
  double develop_ms_ = 0.0;
};

}  // namespace nutik
