// Blends the functions of a hard mask along its edges (docs/reference/masks.md, "Soft masks").
//
//   in:      a mask, and how far an edge reaches: for all tags, or for some of them
//   out:     the same mask with shares: α of each tag at each pixel
//   always:  shares follow from whole numbers and quotients of doubles alone: they are the same on every machine. A
//            pixel further from all edges than they reach keeps its tag
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "exposure/mask.hpp"
#include "system/interruption.hpp"

namespace nutik {

// How far an edge reaches to either side, in hundredths of a pixel.
struct Feather {
  static constexpr std::int32_t kMaxCentipixels = 500 * 100;

  std::int32_t everywhere_centipixels = 0;
  std::map<std::uint8_t, std::int32_t> of_tag;  // where it is another

  // `6px`, `2.5px`; `M255=6px` of one tag; several with commas between: `2px,M255=6px`. Throws UsageError.
  [[nodiscard]] static Feather parse(const std::string& text);

  [[nodiscard]] std::int32_t of(std::uint8_t tag) const {
    const auto found = of_tag.find(tag);
    return found == of_tag.end() ? everywhere_centipixels : found->second;
  }
  friend bool operator==(const Feather&, const Feather&) = default;
};

// The mask is a hard one. Throws UsageError where no pixel has a tag with a feather of its own.
[[nodiscard]] Mask feathered(const Mask& mask, const Feather& feather, const ReportedProgress& progress = {});

}  // namespace nutik
