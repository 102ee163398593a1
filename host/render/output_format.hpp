// How a picture is stored, and what that leaves no room for.
#pragma once

#include <cstdint>
#include <optional>

#include "capture/picture.hpp"

namespace nutik {

// What codes say of light below 0. saturate: code 0; offset: light 0 has the middle code, each sign half of
// the codes; absolute: as much light above 0.
enum class NegativeLight { saturate, offset, absolute };

// How a picture's values are to be stored. Codes saturate at 0 and at the white code; light is kept as it is, in the
// capture's primaries.
struct OutputFormat {
  ValueType type = ValueType::code8;
  std::uint32_t white_code = 255;
  NegativeLight negative = NegativeLight::saturate;  // of codes
  // Codes that are made to be seen have this function and BT.709's primaries, white being the capture's reference
  // white. None: the capture's own function and primaries, and white the light of its white code.
  std::optional<Transfer> transfer = std::nullopt;
  bool is_half = false;      // light becomes floating point of 16 bits in its file
  bool maps_bounds = false;  // a session adds a map of what each pixel may be off by

  friend bool operator==(const OutputFormat&, const OutputFormat&) = default;
};

// How the light of a capture becomes codes.
struct CodeMaking {
  Transfer transfer;
  double white_light;  // that has the white code
  Primaries primaries;
  std::optional<ColourMatrix>
      conversion;  // of the capture's primaries to these; none where they are the same

  [[nodiscard]] static CodeMaking of(const CaptureFormat& capture, const OutputFormat& output) {
    if (!output.transfer) return {capture.transfer, 1.0, capture.primaries, std::nullopt};
    CodeMaking making{*output.transfer, capture.transfer.reference_white(), Primaries::bt709, std::nullopt};
    if (capture.shape.channels == 3 && capture.primaries != Primaries::bt709)
      making.conversion = to_bt709(capture.primaries);
    return making;
  }
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
