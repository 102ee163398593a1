// A picture file, codes as they stand.
#pragma once

#include <string>

#include "capture/error.hpp"
#include "capture/picture.hpp"

namespace nutik {

// It is no picture, or many.
struct NoSinglePicture : UsageError {
  using UsageError::UsageError;
};

// Throws NoSinglePicture, InputError where it cannot be read.
[[nodiscard]] Picture read_picture(const std::string& name);

}  // namespace nutik
