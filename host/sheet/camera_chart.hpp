// How a camera moved, as a graph.
#pragma once

#include <string>

#include "align/camera_path.hpp"
#include "capture/picture.hpp"
#include "capture/timeline.hpp"

namespace nutik::sheet {

// Two graphs over time: how far to the right and down the scene lies from where it lay in the reference, in pixels; and
// how far it is turned. The timeline has the path's pictures.
[[nodiscard]] Picture camera_chart(const std::string& heading, const CameraPath& path,
                                   const Timeline& timeline);

}  // namespace nutik::sheet
