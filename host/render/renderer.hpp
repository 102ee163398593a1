// What every renderer offers: a plan and the capture it was made for in, a picture and all that is to be said of it
// out.
//
//   always:  what a render did comes back with its picture; a renderer remembers nothing of it
//   threads: any number may ask one renderer at a time. Renders that share a device take turns
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "capture/picture.hpp"
#include "imev/capture_source.hpp"
#include "render/error_bound.hpp"
#include "render/output_format.hpp"
#include "render/render_plan.hpp"
#include "system/interruption.hpp"

namespace nutik {

// The largest error that a picture is given, in steps of its format (PictureError::steps).
inline constexpr double kMaxSteps = 0.5;

struct PrecisionChoice {
  ErrorBound bound;                  // of the arithmetic that was chosen
  std::vector<ErrorBound> rejected;  // faster ones that may err by more than kMaxSteps

  [[nodiscard]] Precision precision() const { return bound.precision; }
  [[nodiscard]] bool is_right_enough() const { return bound.worst.steps <= kMaxSteps; }
};

// `auto`: the first of `available` (fastest first, not empty) whose bound keeps the format within kMaxSteps; where none
// does, the one with the least bound. Known before a sample is read, and the same on every device that has the same
// arithmetics.
[[nodiscard]] PrecisionChoice choose_precision(const RenderPlan& plan, const OutputFormat& output,
                                               std::span<const Precision> available);

// Throws ImpreciseError where what the reference makes, and whatever combines samples as it does, may err by more than
// kMaxSteps.
void check_reference_strictly(const RenderPlan& plan, const OutputFormat& output);

// `0.5 of a code`; `single is not sure to be right to 0.5 of a code here`
[[nodiscard]] std::string half_step_text(const OutputFormat& output);
[[nodiscard]] std::string not_sure_text(std::string_view who, const OutputFormat& output);
// `light within 3.1e-07, 0.01 of an 8-bit code`
[[nodiscard]] std::string error_text(const PictureError& error, const OutputFormat& output);

// What one render is asked for beside its picture.
struct RenderControl {
  std::stop_token stop = {};                          // looked at between launches: render() throws Cancelled
  ReportedProgress progress = {};                     // told how far it is; of several devices, how far the first one
  std::optional<Rectangle> rectangle = std::nullopt;  // only these pixels, which are the whole picture's; none: all
  std::optional<Precision> precision = std::nullopt;  // instead of what the renderer was made with
  bool is_chosen = false;  // no person asked for that: what is doubtful about it is told by who chose it
  bool strict = false;  // ImpreciseError where the picture may err by more than kMaxSteps
  bool takes_wrong = false;  // to measure an arithmetic that its device computes wrongly; else it is refused

  // Where there are several devices, the one that is free first makes all of it: pictures that are asked for at the
  // same time are then made by different devices.
  bool by_one_device = false;

  // What the render may take, the picture included: MemoryTooLittle where that does not do. 0: it may take what the
  // renderer was made with for blocks, and for the picture what that needs.
  std::uint64_t memory_bytes = 0;
};

// What a render took.
struct RenderStatistics {
  double read_ms = 0.0;    // waited for payloads to be where the kernel reads them: unpacking, copying
  double expose_ms = 0.0;  // of the kernels, by the device's own clock
  double develop_ms = 0.0;
  bool is_timed = true;                   // false: the driver does not time kernels, and both are 0
  std::uint64_t payload_bytes = 0;        // read by the kernel
  std::uint64_t device_bytes = 0;         // largest sum of buffers at a time
  std::uint64_t table_bytes_written = 0;  // of gain tables, and
  std::uint64_t map_bytes_written =
      0;  // of functions of pixels, that were not on the device from renders before
  // Where a capture is resident: functions whose pixels were not as in the render before; sums of blocks, halves and
  // bundles that were not made again, and those that were made to be kept.
  std::uint64_t exposed_functions = 0;
  std::uint64_t kept_sums = 0;
  std::uint64_t made_sums = 0;
  std::uint64_t blocks = 0;
  std::uint64_t launches = 0;  // of the kernel that exposes: a chunk of blocks in a band of the picture each
};

struct Rendered {
  Picture picture;
  std::string renderer;  // what did the work, as Renderer::name()
  Precision precision = Precision::double_;
  Saturation saturation;  // none where light was kept
  std::optional<PrecisionChoice>
      choice;                    // the arithmetic's bound and what was not taken; none of the reference
  bool passed_self_test = true;  // false: RenderControl::takes_wrong, and it is
  RenderStatistics statistics;
  std::vector<std::string> warnings;  // what is doubtful about the picture, whole sentences
};

// Adds what there is to say of a part of the same picture, made beside the others or after them; not its pixels.
void add_part(Rendered& whole, const Rendered& part, bool is_made_beside);

class Renderer {
 public:
  virtual ~Renderer() = default;

  // Blocks of this capture stay where they are rendered from once they have been read, as far as memory
  // allows, so that the next picture of it needs not read them again. Until another is named; null: of none. The
  // capture must live that long. A renderer may do without.
  virtual void keep_resident(const CaptureSource* /*source*/) {}

  // Does ahead what render() needs no capture for: kernels are built or loaded, and tested where no verdict on them is
  // known. May be left out.
  virtual void prepare(const RenderPlan& /*plan*/, const OutputFormat& /*output*/) {}

  // Exposes a picture. `source` is the capture that the plan was made for; its blocks are read in time
  // order. Throws InputError for a damaged block, DeviceError where the device fails, UsageError for a rectangle
  // that is empty or leaves the picture, Cancelled.
  [[nodiscard]] Rendered render(const RenderPlan& plan, CaptureSource& source, const OutputFormat& output,
                                const RenderControl& control = {});

  // What does the work, as a person would call it: a device's name, "scalar reference".
  [[nodiscard]] virtual std::string name() const = 0;

 private:
  // Renders a rectangle that lies within the picture.
  [[nodiscard]] virtual Rendered render_part(const RenderPlan& plan, CaptureSource& source,
                                             const OutputFormat& output, const Rectangle& rectangle,
                                             const RenderControl& control) = 0;
};

inline void throw_if_cancelled(const RenderControl& control) {
  if (control.stop.stop_requested()) throw Cancelled();
}

// What a render did and took, for a person, in two lines: blocks, times and memory; the arithmetic, its bound, and
// those of arithmetics that were not taken. Empty of the reference, which measures nothing.
[[nodiscard]] std::string rendering_report(const Rendered& rendered, const OutputFormat& output);

}  // namespace nutik
