// A part of a clip: some of its pictures, a rectangle of each, and fewer pixels.
//
//   in:      a clip, what is stated of its part
//   out:     a clip whose info is that of the part
//   always:  what pictures begin at, from or before a moment, counts; what they were exposed for stays as it was
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "media/clip.hpp"

namespace nutik {

// Pixels are means of light: of n x n pixels where the scale is 1/n (what is left over at the right and at the bottom
// is left out), else of the area that a new pixel covers. A mean becomes the code whose light is next to it. Throws
// UsageError where the part lies outside the clip or a scale would enlarge it, InputError where moments are times and
// nothing tells how fast the clip was taken.
[[nodiscard]] std::unique_ptr<Clip> take_part(std::unique_ptr<Clip> clip, const std::filesystem::path& path,
                                              const ClipOptions& options);

// The rectangle that facts of a part tell; none where it is of whole pictures.
[[nodiscard]] std::optional<Rectangle> crop_told(const std::vector<std::string>& facts);

}  // namespace nutik
