// Whether the camera of a capture moved.
#pragma once

#include <optional>
#include <string>

#include "session/memory_budget.hpp"
#include "tik/reader.hpp"

namespace nutik {

struct MovedCamera {
  double pixels = 0;  // of the place that moved furthest
  double degrees = 0;
  std::uint64_t sample = 0;  // at which, from the first sample
  // `the camera moved: …`
  [[nodiscard]] std::string text() const;
};

// What a look takes, beside blocks of the capture.
[[nodiscard]] MemoryNeeds camera_check_needs(const CaptureFormat& capture);

// Looks at a few samples. Nothing of a capture whose pictures were aligned, nor where it stands still, nor where most of
// the picture follows no motion of a camera. Throws InputError where the capture is damaged.
[[nodiscard]] std::optional<MovedCamera> moved_camera(tik::Reader& capture);

}  // namespace nutik
