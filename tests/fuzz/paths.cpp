// Paths of cameras; what is read from one is read again, identically, from what is written of it, and leads each row of
// its pictures to pixels of theirs.
#include "align/camera_path.hpp"

#include <algorithm>

#include "fuzz/target.hpp"

namespace nutik::fuzz {
namespace {

constexpr std::uint32_t kMaxRows = 1000;

void read(Bytes input) {
  const CameraPath path = parse_camera_path(as_text(input), "input.csv");
  demand(parse_camera_path(camera_path_text(path), "again") == path,
         "a path is read from its text as it was");
  for (const Registered& picture : path.pictures) {
    for (std::uint32_t row = 0; row < std::min(path.shape.height, kMaxRows); ++row) {
      const PixelSpan seen = seen_span(picture.warp, path.shape, row);
      demand(seen.first <= seen.end && seen.end <= path.shape.width, "what is seen lies in the picture");
    }
  }
}

}  // namespace

const Target kTarget{{1 << 22, 2000}, read};

}  // namespace nutik::fuzz
