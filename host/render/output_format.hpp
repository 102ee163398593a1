// How a picture is stored, and what that leaves no room for.
#pragma once

#include <cstdint>

#include "capture/picture.hpp"

namespace nutik {

// What codes say of light below 0. saturate: code 0; offset: light 0 has the middle code, each sign half of
// the codes; absolute: as much light above 0.
enum class NegativeLight { saturate, offset, absolute };

// How a picture's values are to be stored. Codes are made with the capture's transfer function and
// saturate at 0 and at the white code; light is kept as it is.
struct OutputFormat {
  ValueType type = ValueType::code8;
  std::uint32_t white_code = 255;
  NegativeLight negative = NegativeLight::saturate;  // of codes

  friend bool operator==(const OutputFormat&, const OutputFormat&) = default;
};

// How many pixels hold light that no code was left for (render/code_scale.hpp).
struct Saturation {
  std::uint64_t below = 0;
  std::uint64_t above = 0;

  Saturation& operator+=(const Saturation& other) {
    below += other.below;
    above += other.above;
    return *this;
  }
  friend bool operator==(const Saturation&, const Saturation&) = default;
};

}  // namespace nutik
