// Whether a driver computes rightly what a picture is about to be computed with.
//
//   in:      an arithmetic, the codes that its kernels were built for, and whoever renders with these kernels
//   out:     a verdict: how far light and codes are from the reference's, and whether that is within the bound
//   always:  the same two scenes on every device, small enough to cost milliseconds
//
// The first scene has tiles of every kind, whole and cut by the picture's edges, with one function and with several, in
// blocks whose indices take one byte and two, some of them outside a function's time. Its codes are the capture's own,
// from 0 to white. The second is one pixel for longer than 65 535 samples: there are drivers that end long loops early.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "imev/capture_source.hpp"
#include "render/precision.hpp"
#include "render/render_plan.hpp"
#include "render/renderer.hpp"

namespace nutik {

struct Verdict {
  bool is_right = true;
  double light_error = 0.0;       // that takes most of its bound, in light; infinite if a value is no number
  double allowed_error = 0.0;     // its bound
  std::uint64_t wrong_codes = 0;  // that the bound does not explain
  std::uint64_t codes = 0;        // compared; 0 if pictures hold light

  friend bool operator==(const Verdict&, const Verdict&) = default;
};

// `light is wrong by 0.1 instead of 3e-07`, `37 of 3741 codes are wrong`
[[nodiscard]] std::string fault_text(const Verdict& verdict);

using RenderScene = std::function<Picture(const RenderPlan&, CaptureSource&, const OutputFormat&)>;

// What pixels of the picture may have.
struct TestedPixels {
  bool share_functions = false;
  bool have_delays = false;
};

// `like` is the capture whose shape alone is not the scenes'. `output` is how the picture will be stored.
[[nodiscard]] Verdict self_test(const CaptureFormat& like, Precision precision, const OutputFormat& output,
                                const TestedPixels& pixels, const RenderScene& render);

// The same of a plan that lightens or darkens, `scales` by gains that differ or not: no value may differ.
[[nodiscard]] Verdict self_test_combining(const RenderPlan& like, bool scales, const RenderScene& render);

}  // namespace nutik
