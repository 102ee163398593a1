// ICC profiles, which say what the values of a picture mean: written for formats that have no tags of their own for it,
// read from all that hold them.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/picture.hpp"

namespace nutik {

// The same bytes for the same meaning, whenever it is made. Empty where nobody said what codes stand for.
[[nodiscard]] std::vector<std::byte> colour_profile(const Picture& picture);

// What a profile says that is known here; none where it says something else, or nothing can be read of it.
struct ProfiledColours {
  std::string name;  // by which it calls itself, for people: visible ASCII, and short
  std::optional<Transfer> transfer;
  std::optional<Primaries> primaries;  // of colour
};
// A curve is taken for a transfer function from which it differs by less than half a code of 8 bits everywhere, and
// primaries for those from which they differ by less than half a code of white.
[[nodiscard]] ProfiledColours read_colour_profile(std::span<const std::byte> profile);

}  // namespace nutik
