#include "align/camera_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "capture/format.hpp"

namespace nutik {
namespace {

constexpr std::array<std::pair<CameraMotion, std::string_view>, 3> kMotions{
    {{CameraMotion::translation, "translation"},
     {CameraMotion::rigid, "rigid"},
     {CameraMotion::homography, "homography"}}};

// The picture of which `measure` is largest, the first of them.
template <typename Measure>
std::uint64_t largest(const CameraPath& path, Measure measure) {
  std::uint64_t best = 0;
  for (std::uint64_t picture = 1; picture < path.pictures.size(); ++picture) {
    if (measure(path.step(picture)) > measure(path.step(best))) best = picture;
  }
  return best;
}

double distance(const CameraPath::Step& step) { return std::hypot(step.x, step.y); }

}  // namespace

std::string_view to_text(CameraMotion motion) {
  return std::ranges::find(kMotions, motion, &decltype(kMotions)::value_type::first)->second;
}

std::optional<CameraMotion> camera_motion_of(std::string_view text) {
  const auto found = std::ranges::find(kMotions, text, &decltype(kMotions)::value_type::second);
  return found == kMotions.end() ? std::nullopt : std::optional(found->first);
}

std::uint64_t registered_bytes(const CaptureFormat& format) {
  constexpr std::uint64_t kPyramidBytes = 12;  // a pixel: as it is, blurred, and all smaller ones
  return kPyramidBytes * format.shape.pixel_count();
}

MemoryNeeds registrar_needs(const CaptureFormat& format, Reach reach) {
  constexpr std::uint64_t kTextureBytes = 4 << 20;
  constexpr std::uint64_t kFeatureBytes =
      240;  // a pixel of what features are looked for in: twice its size, in
            // eleven layers of floats, and all smaller ones
  constexpr std::uint64_t kMaxFeaturePixels = 480 * 480;
  const std::uint64_t pixels = format.shape.pixel_count();
  MemoryNeeds needs{{"a picture that is registered", registered_bytes(format)}, {"its texture", kTextureBytes}};
  if (reach == Reach::anywhere)
    needs.add("its features", kFeatureBytes * std::min(pixels, kMaxFeaturePixels));
  return needs;
}

CameraPath::Step CameraPath::step(std::uint64_t picture) const {
  const double x = (shape.width - 1) / 2.0, y = (shape.height - 1) / 2.0;
  const Warp& warp = pictures[picture].warp;
  const Place place = warp.at(x, y);
  return {place.x - x, place.y - y, warp.degrees_at(x, y)};
}

std::uint64_t CameraPath::furthest() const { return largest(*this, distance); }

std::uint64_t CameraPath::max_turned() const {
  return largest(*this, [](const Step& step) { return std::abs(step.degrees); });
}

double CameraPath::residual_pixels() const {
  return pictures.empty() ? 0 : std::ranges::max(pictures, {}, &Registered::residual_pixels).residual_pixels;
}

std::string CameraPath::summary() const {
  std::string text = format("moved by up to {:.2f} pixels", distance(step(furthest())));
  if (motion == CameraMotion::translation) return text;
  return text + format(", turned by up to {:.3f} degrees", std::abs(step(max_turned()).degrees));
}

}  // namespace nutik
