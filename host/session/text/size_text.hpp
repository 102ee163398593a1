// Sizes for people.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "capture/picture.hpp"
#include "render/output_format.hpp"

namespace nutik {

[[nodiscard]] std::string counted(std::uint64_t count, std::string_view name);  // `1 block`, `2 blocks`
// `12 pixels saturated below 0 and 3 above 1`, `no pixel saturated`.
[[nodiscard]] std::string saturated_text(const Saturation& saturation);
[[nodiscard]] std::string bytes_text(std::uint64_t bytes);  // `94 kB`, `1.49 GB`
[[nodiscard]] std::string shape_text(const Shape& shape);   // `640 x 480 colour`

// `32:27`
[[nodiscard]] std::string aspect_text(const Rational& aspect);

}  // namespace nutik
