// A picture file, codes as they stand.
#pragma once

#include <string>

#include "capture/picture.hpp"

namespace nutik {

// Throws UsageError where it is no picture, or many; InputError where it cannot be read.
[[nodiscard]] Picture read_picture(const std::string& name);

}  // namespace nutik
