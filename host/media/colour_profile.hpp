// An ICC profile that says what the values of a picture mean, for formats that have no tags of their own for it.
#pragma once

#include <cstddef>
#include <vector>

#include "capture/picture.hpp"

namespace nutik {

// The same bytes for the same meaning, whenever it is made. Empty where nobody said what codes stand for.
[[nodiscard]] std::vector<std::byte> colour_profile(const Picture& picture);

}  // namespace nutik
