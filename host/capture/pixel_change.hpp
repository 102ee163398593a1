// A pixel whose codes change, told on its own: what cameras write that take no pictures.
#pragma once

#include <array>
#include <cstdint>

namespace nutik {

// From a sample on a pixel holds these codes, as many as there are channels.
struct PixelChange {
  std::uint32_t pixel = 0;  // row by row from the top left
  std::array<std::uint16_t, 3> codes{};
  friend bool operator==(const PixelChange&, const PixelChange&) = default;
};

}  // namespace nutik
