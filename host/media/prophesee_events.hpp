// Files of Prophesee's cameras: RAW, as the sensor sent it (EVT 2.0, 2.1 and 3.0), and DAT.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "media/camera_events.hpp"
#include "media/clip.hpp"

namespace nutik {

// Reads all of a file whose name is `name` and that begins with `% `: once to count its events, and again if there is
// memory for them. Throws InputError if it is of another kind, or holds no event; MemoryTooLittle.
[[nodiscard]] CameraEvents read_prophesee_events(std::span<const std::byte> file, const std::string& name,
                                                 const ClipOptions& options);

}  // namespace nutik
