// How one pixel of an exposure came about: the steps of the reference's own walk, and what they come to.
//
//   in:      a plan, the capture it was made for, and a pixel or a mask value
//   out:     from edge to edge: light, gain, what they add, and the sum so far; of a pixel that several functions share
//            for each of them
//   units:   light of white is 1; integrals are light × gain × nanoseconds
//   always:  each step begins where the one before it ended; a trace of a pixel comes to the light that
//            ReferenceRenderer gives it, to the last bit
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "imev/capture_source.hpp"
#include "render/render_plan.hpp"
#include "system/interruption.hpp"

namespace nutik {

// From one edge (a change record, a control point, or the first sample of a block) to the next. Light and
// gain run straight in between.
struct TraceStep {
  struct Value {
    double begin_light = 0.0;
    double end_light = 0.0;
    double integral_ns = 0.0;  // ∫ light × gain from edge to edge
    double sum_ns = 0.0;       // of the integrals up to here
  };

  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  double begin_gain = 0.0;
  double end_gain = 0.0;
  bool is_made = false;  // the sample that it begins with, between two that were filmed (capture/made_samples.hpp)
  std::array<Value, 3> values{};  // as many as there are channels
};

struct Trace {
  std::uint32_t channels = 0;
  std::uint64_t pixel_count = 0;      // whose mean it is
  std::size_t function = 0;           // the plan's
  std::uint32_t share = kWholeShare;  // of a pixel's light that it has
  std::vector<TraceStep> steps;       // of the blocks that the function needs, none where it is 0
  std::array<double, 3> light{};      // the exposure's, by channel
};

// One for each function that exposes the pixel. Throws UsageError where the picture has no such pixel, InputError for a
// damaged block. `progress` is told of blocks.
[[nodiscard]] std::vector<Trace> trace_pixel(const RenderPlan& plan, CaptureSource& source, std::uint32_t x,
                                             std::uint32_t y, const ReportedProgress& progress = {});

// The light that a pixel's traces come to together, by channel.
[[nodiscard]] std::array<double, 3> light_of(std::span<const Trace> traces);

// The mean over all pixels with this mask value, each by the share that it has of the pixel: the walk along the mean of
// their light. Throws UsageError where no pixel has it. `progress` is told of rows of blocks.
[[nodiscard]] Trace trace_region(const RenderPlan& plan, CaptureSource& source, std::uint8_t tag,
                                 const ReportedProgress& progress = {});

}  // namespace nutik
