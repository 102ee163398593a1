// What the description of a TIFF says of its pages beside what their directories do: ImageJ, tifffile and OME write there
// how many pictures there are, of how many channels and slices, and how fast they were taken.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "capture/picture.hpp"
#include "capture/rational.hpp"

namespace nutik {

struct TiffStory {
  std::uint64_t pictures = 0;    // 0: it does not say
  std::string mixed;             // of what there is more than one beside moments, for people: `2 channels, 2 slices`
  std::optional<Rational> rate;  // pictures a second
  std::string who;               // whose words these are
};

// Of pages of that shape.
[[nodiscard]] TiffStory read_tiff_story(std::string_view description, const Shape& page);

}  // namespace nutik
