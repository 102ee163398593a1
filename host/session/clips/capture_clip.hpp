// A capture as a clip again: its samples, one after another, with their times.
#pragma once

#include <memory>

#include "imev/capture_source.hpp"
#include "media/clip.hpp"

namespace nutik {

// The capture outlives the clip. Where exposures follow each other evenly the clip tells their rate; how long each
// lasts is the capture's shutter angle, which no clip tells.
[[nodiscard]] std::unique_ptr<Clip> open_capture_clip(CaptureSource& capture);

}  // namespace nutik
