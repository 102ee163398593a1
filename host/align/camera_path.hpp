// How a camera moved in the course of a clip.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "align/registrar.hpp"

namespace nutik {

struct CameraPath {
  CameraMotion motion = CameraMotion::rigid;
  Shape shape;                       // of the pictures; channels do not count
  std::uint64_t reference = 0;       // the picture that the others were registered to
  std::vector<Registered> pictures;  // each from the reference to its own places

  // How far what a picture shows in its middle has moved since the reference, and by how much it has turned.
  struct Step {
    double x = 0, y = 0;
    double degrees = 0;
  };
  [[nodiscard]] Step step(std::uint64_t picture) const;
  // The pictures in which it is furthest away, and turned most.
  [[nodiscard]] std::uint64_t furthest() const;
  [[nodiscard]] std::uint64_t max_turned() const;
  // The largest of all pictures.
  [[nodiscard]] double residual_pixels() const;
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

}  // namespace nutik
