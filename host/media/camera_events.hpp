// The events of a contrast-detecting camera, as its file tells them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "capture/error.hpp"

namespace nutik {

// The light of a pixel rose or fell by one step.
struct CameraEvent {
  std::int64_t time_us;  // of the camera's clock
  std::uint16_t x, y;
  bool is_up;
};

struct CameraEvents {
  std::string kind;  // of the file, for people: `EVT 2.0`
  std::uint32_t width = 0, height = 0;
  std::string size_from;  // what of the file tells the size; empty: it is assumed
  std::vector<CameraEvent> events;  // in the order of their times
  std::vector<Note> notes;
};

}  // namespace nutik
