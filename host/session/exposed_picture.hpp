// A picture, and all that is to be said of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "capture/picture.hpp"
#include "capture/timeline.hpp"
#include "render/render_plan.hpp"
#include "render/renderer.hpp"
#include "session/uncertainty.hpp"

namespace nutik {

// What an exposure touches of a capture.
struct ExposureFigures {
  CaptureFormat capture;
  Timeline timeline;                       // of a clip that was read once, as it turned out to be
  std::vector<PlannedFunction> functions;  // that the mask uses, by increasing mask value; without tables
  std::uint64_t live_samples = 0;          // that some function exposes
  SampleRange read;                        // whole blocks
  std::uint64_t blocks_read = 0;
  // The capture's; none for a clip, whose blocks are made as it is read.
  std::optional<std::uint64_t> block_count;
  std::uint64_t table_bytes = 0;  // of gains
  std::uint64_t map_bytes = 0;    // of functions by pixel
  Combine combine = Combine::integral;
  bool has_delays = false;  // functions are told as they are without theirs
  // The largest of any function, each with its own delay: S, and what rounding of times costs.
  double error_scale = 0.0, times_error = 0.0;

  // Takes the functions out of the plan.
  static ExposureFigures of(RenderPlan&& plan, const Timeline& timeline,
                            std::optional<std::uint64_t> block_count);
};

// Values that became infinite when light was added up: how many, and a whole sentence of those of a picture.
[[nodiscard]] std::uint64_t infinite_values(const Picture& picture);
[[nodiscard]] std::optional<std::string> infinity_warning(const Picture& picture);

// `warnings` are those of the plan and of the renderer.
struct ExposedPicture : Rendered {
  ExposureFigures figures;
  OutputFormat output;
  Uncertainty uncertainty = {};
  std::vector<PictureLayer> bounds = {};  // UncertaintyMap::layers(); none without OutputFormat::maps_bounds

  // What the arithmetic may be off by, in words; empty where it was not chosen, as of the reference.
  [[nodiscard]] std::string error_bound() const {
    return choice ? error_text(choice->bound.worst, output) : std::string();
  }
};

}  // namespace nutik
