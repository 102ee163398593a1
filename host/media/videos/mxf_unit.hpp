// What the metadata of an MXF file say of the camera.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "capture/rational.hpp"

namespace nutik::videos {

// In the words of Sony's XML: `s-log3-cine`, `s-gamut3-cine`. Empty where it is not said.
struct CameraUnit {
  std::string curve, gamut;
  std::optional<Rational> rate;  // pictures a second
  std::string from = "the file";  // what says it
};

// The labels that describe the pictures, and those of the first ancillary data beside them (SMPTE RDD 18), which stay
// where the description was written anew. All is empty in a file of another kind. The rate of interlaced files is not
// read, for they may count fields.
[[nodiscard]] CameraUnit mxf_unit(std::string_view file);

}  // namespace nutik::videos
