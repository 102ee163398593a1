#include "session/clips/camera_check.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "align/registrar.hpp"
#include "capture/format.hpp"
#include "imev/each_block.hpp"
#include "media/module.hpp"

namespace nutik {
namespace {

constexpr std::uint64_t kLooks = 9;
// Less is not told from what compression and rolling shutters do.
constexpr double kMinPixels = 1.0;

// How far the corner that moves furthest does.
double furthest_corner(const Warp& warp, const Shape& shape) {
  double most = 0;
  for (const double x : {0.0, shape.width - 1.0}) {
    for (const double y : {0.0, shape.height - 1.0}) {
      const Place place = warp.at(x, y);
      most = std::max(most, std::hypot(place.x - x, place.y - y));
    }
  }
  return most;
}

}  // namespace

std::string MovedCamera::text() const {
  return format(
      "the camera moved: at sample {} its picture lies up to {:.1f} pixels from where it lay at first, "
      "turned by {:.2f} degrees, and still things are not still",
      sample, pixels, degrees);
}

MemoryNeeds camera_check_needs(const CaptureFormat& capture) {
  MemoryNeeds needs = registrar_needs(capture, Reach::near);
  needs.add("a picture of the capture", capture.sample_bytes());
  return needs;
}

std::optional<MovedCamera> moved_camera(tik::Reader& capture) {
  if (capture.header().alignment) return std::nullopt;
  const CaptureFormat& format = capture.format();
  const std::uint64_t count = capture.timeline().sample_count();
  std::vector<std::byte> raster(format.sample_bytes());
  std::unique_ptr<Registrar> registrar;
  std::optional<MovedCamera> moved;
  double most = kMinPixels;
  for (std::uint64_t look = 0; look < std::min(count, kLooks); ++look) {
    const std::uint64_t sample = count <= kLooks ? look : look * (count - 1) / (kLooks - 1);
    for_each_block(capture, {sample, sample + 1}, [&](const BlockView& block) {
      block.read_sample(static_cast<std::uint32_t>(sample - block.extent().first_sample), raster);
    });
    if (!registrar) {
      try {
        registrar = motion_module().open(format, CameraMotion::rigid, raster);
      } catch (const TooLittleTexture&) {
        return std::nullopt;
      }
      continue;
    }
    // From where it lay at first: what stands still is found there.
    const Registered found = registrar->find(raster, Warp(), Reach::near);
    const double corner = furthest_corner(found.warp, format.shape);
    if (!is_sure(found) || corner < most) continue;
    most = corner;
    const double degrees =
        found.warp.degrees_at((format.shape.width - 1) / 2.0, (format.shape.height - 1) / 2.0);
    moved = {corner, std::abs(degrees), sample};
  }
  return moved;
}

}  // namespace nutik
