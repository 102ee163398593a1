// Renders a picture with the reference and in every arithmetic of a device: how right each is, and how fast.
//
//   in:      a plan, its capture, the picture's format, a device
//   out:     for each arithmetic its bound, its errors against the reference, its times
//   always:  all kernels are built before anything is timed; timed renders take turns, so that what else the machine
//            does hits all arithmetics alike. They read the capture anew, unless whoever asks has made it resident
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "opencl/opencl_renderer.hpp"
#include "render/picture_errors.hpp"

namespace nutik {

struct ValidatedVariant {
  ErrorBound bound;
  LightErrors light;
  StoredErrors stored;
  // Medians of the timed renders: the kernels by the device's own clock, and all of a render by the host's.
  double expose_ms = 0.0;
  double develop_ms = 0.0;
  double render_ms = 0.0;
  bool is_timed = true;             // false: the driver does not time kernels, whose times are 0 then
  std::uint64_t payload_bytes = 0;  // that the kernel read

  [[nodiscard]] Precision precision() const { return bound.precision; }
  [[nodiscard]] bool is_within_bound() const { return nutik::is_within_bound(light, stored); }
  // Payload alone counts; 0 where nothing was read.
  [[nodiscard]] double gigabytes_per_second() const;
};

struct Validation {
  OutputFormat output;
  std::vector<ValidatedVariant> variants;  // the fastest first, as precisions_of() has them
  std::size_t chosen = 0;                  // the variant that choose_precision() takes
  double reference_ms = 0.0;

  [[nodiscard]] bool is_within_bounds() const;
};

// `runs` renders are timed in each arithmetic; at least 1. `progress` is told how many of `total` renders are done.
[[nodiscard]] Validation validate(
    const RenderPlan& plan, CaptureSource& capture, const OutputFormat& output, OpenClRenderer& renderer,
    std::uint32_t runs, const std::function<void(std::uint64_t done, std::uint64_t total)>& progress,
    std::uint64_t memory_bytes = 0);

}  // namespace nutik
