// What counts as a change. A record is written when a pixel's code differs from the code it holds by
// more than the tolerance in any channel; 0 keeps every change and is lossless.
#pragma once

#include <cstdint>

namespace nutik {

struct NoiseModel {
  std::uint32_t tolerance = 0;  // codes

  [[nodiscard]] bool is_lossless() const { return tolerance == 0; }
  friend bool operator==(const NoiseModel&, const NoiseModel&) = default;
};

}  // namespace nutik
