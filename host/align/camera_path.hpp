// How a camera moved in the course of a clip, and what of the reference's picture the others saw.
//
// A picture saw a place if it lies between the middles of its border's pixels: nothing is made up.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "align/registrar.hpp"
#include "capture/picture.hpp"
#include "capture/timeline.hpp"

namespace nutik {

// Places that not every aligned picture saw are cut away, or hold what was seen there before.
enum class Unseen { cropped, held };

// The way of a picture's corner or its middle, whichever goes furthest.
[[nodiscard]] Place furthest_way(const Warp& warp, const Shape& shape);

struct CameraPath {
  CameraMotion motion = CameraMotion::rigid;
  Shape shape;                       // of the pictures; channels do not count
  std::uint64_t reference = 0;       // the picture that the others were registered to
  std::vector<Registered> pictures;  // each from the reference to its own places
  bool is_stated = false;            // in a file, not found in these pictures

  // How far what a picture shows in its middle has moved since the reference, and by how much it has turned.
  struct Step {
    double x = 0, y = 0;
    double degrees = 0;
  };
  [[nodiscard]] Step step(std::uint64_t picture) const;
  // Where most of it has moved: the picture, and the way there of its corner or its middle that went furthest.
  struct Furthest {
    std::uint64_t picture = 0;
    Place way;
    [[nodiscard]] double pixels() const { return std::hypot(way.x, way.y); }
  };
  [[nodiscard]] Furthest furthest() const;
  [[nodiscard]] std::uint64_t max_turned() const;  // the picture that is turned most
  // The largest residual of all pictures; none of a path that was read: it may be another clip's, or changed by hand.
  [[nodiscard]] std::optional<double> residual_pixels() const;
  // `moved by up to 12.3 pixels, turned by up to 0.41 degrees`
  [[nodiscard]] std::string summary() const;

  friend bool operator==(const CameraPath& a, const CameraPath& b) {
    return a.motion == b.motion && a.reference == b.reference && a.pictures == b.pictures &&
           a.shape.width == b.shape.width && a.shape.height == b.shape.height;
  }
};

// As a file has it: a line that says what it is, a line of columns, and one for each picture. What is read again is the
// warp of each, m0 … m8; the other columns are for people.
[[nodiscard]] std::string camera_path_text(const CameraPath& path);
// Throws InputError naming `name` and the line.
[[nodiscard]] CameraPath parse_camera_path(std::string_view text, const std::string& name);

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

// Two graphs over time: how far to the right and down the scene lies from where it lay in the reference, in pixels; and
// how far it is turned. The timeline has the path's pictures.
[[nodiscard]] Picture camera_chart(const std::string& heading, const CameraPath& path,
                                   const Timeline& timeline);

}  // namespace nutik
