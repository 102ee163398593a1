// Masks as layers: a grey picture for each tag, whose codes say what share of each pixel it has.
//
//   in:      layers of 8 or 16 bits; white is all of a pixel
//   out:     a mask; and layers of 16 bits of a mask
//   always:  where layers come to less than all of a pixel, one tag gets the rest. Where they come to more, beyond what
//            rounding their codes explains, they are refused
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "capture/picture.hpp"
#include "exposure/mask.hpp"
#include "system/interruption.hpp"

namespace nutik {

struct MaskLayer {
  std::uint8_t tag = 0;
  std::string name;  // in messages
  Picture picture;   // of codes, one channel
};

// Throws InputError where sizes differ, or pixels have more than all of them: how many, and the first with what each
// layer says.
[[nodiscard]] Mask mask_of_layers(std::span<const MaskLayer> layers, std::uint8_t rest,
                                  const ReportedProgress& progress = {});

// In 16 bits.
[[nodiscard]] Picture layer_of(const Mask& mask, std::uint8_t tag);

}  // namespace nutik
