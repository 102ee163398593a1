// What of the reference's picture the others saw.
//
// A picture saw a place if it lies between the middles of its border's pixels: nothing is made up.
#pragma once

#include <cstdint>
#include <optional>

#include "align/camera_path.hpp"
#include "capture/picture.hpp"

namespace nutik {

// From `first` on, before `end`; empty where they are equal.
struct PixelSpan {
  std::uint32_t first = 0, end = 0;
};

// In pixels: what lies no further beyond a picture's outermost ones counts as seen. Registering tells no less, and a
// camera that rests saw its whole picture.
inline constexpr double kSeenBeyond = 0.05;

// The pixels of a row of the reference that a picture saw. They are neighbours, for a picture is convex.
[[nodiscard]] PixelSpan seen_span(const Warp& warp, const Shape& shape, std::uint32_t row);

// The largest rectangle that every picture saw; nothing where there is none.
[[nodiscard]] std::optional<Rectangle> seen_by_all(const CameraPath& path);

// How many pictures saw each pixel, as a grey picture: 255 where all did.
[[nodiscard]] Picture coverage_of(const CameraPath& path);

}  // namespace nutik
