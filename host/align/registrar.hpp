// Finding how a camera moved between two pictures.
//
//   in:      a picture that others are registered to, the kind of motion
//   out:     for each other picture the warp from the first one's places to its own, and how well that holds
//   always:  what moves on its own does not count, as long as more of the scene rests; neither does light that becomes
//            brighter or darker as a whole. The same pictures give the same warps
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>

#include "align/flow.hpp"
#include "align/warp.hpp"
#include "capture/memory_needs.hpp"
#include "capture/picture.hpp"
#include "system/shared_state.hpp"

namespace nutik {

enum class CameraMotion {
  translation,  // along the picture's sides
  rigid,        // and turning about the axis of sight
  homography,   // whatever a camera on the spot does, and whatever it does before a plane
  automatic     // rigid, where a homography says no more; of a path that was found it is one of these two
};
[[nodiscard]] std::string_view to_text(CameraMotion motion);
// Nothing where it is none of these.
[[nodiscard]] std::optional<CameraMotion> camera_motion_of(std::string_view text);

struct Registered {
  Warp warp;
  // Share of the textured places, seen in both, that lie within a pixel of where it says.
  double agreeing = 0;
  double residual_pixels = 0;  // half of the textured places are no further from there than this
  friend bool operator==(const Registered&, const Registered&) = default;
};

// A picture that others cannot be registered to.
struct TooLittleTexture : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Larger pictures are looked at as means of 2 x 2 pixels, of 4 x 4 and so on: places are found there as well. Thin ones
// keep a row and a column.
inline constexpr std::uint64_t kMaxRegisteredPixels = std::uint64_t{1} << 19;
[[nodiscard]] inline int registered_halvings(const Shape& shape) {
  int times = 0;
  while (shape.pixel_count() >> 2 * times > kMaxRegisteredPixels &&
         std::min(shape.width, shape.height) >> (times + 1) > 0) {
    ++times;
  }
  return times;
}

// How far from where it is expected a picture may lie.
enum class Reach {
  near,     // a few percent of its size
  anywhere  // as long as it shows much of the same
};

// Parts of a picture: 1 where the second of two motions is better, -1 where the first is, 0 where neither is.
inline constexpr std::size_t kPartsToASide = 8;
using BetterParts = std::array<std::int8_t, kPartsToASide * kPartsToASide>;

class Registrar {
 public:
  virtual ~Registrar() = default;

  // Registers a raster of the same format, expected to lie about where `guess` says. Returns the best that was found,
  // good or not: ask is_sure(). Nearby that is another place only where much of the picture lies there. Several threads
  // may ask at once.
  [[nodiscard]] virtual Registered find(std::span<const std::byte> raster, CameraMotion motion, const Warp& guess,
                                        Reach reach = Reach::anywhere) = 0;

  // Finds a picture by two motions, of which the second can do all that the first does. Each is then fitted to half of
  // the picture's parts: `better` tells which of both predicts better what the other half shows.
  struct Compared {
    std::array<Registered, 2> found;
    BetterParts better{};
  };
  [[nodiscard]] virtual Compared compare(std::span<const std::byte> raster, const std::array<CameraMotion, 2>& motions,
                                         const std::array<Warp, 2>& guesses) = 0;

  // Whether a quarter of the reference or more has texture: it is no thing before a bare wall.
  [[nodiscard]] virtual bool sees_much() const = 0;
};

// Registers other pictures to `reference`, a raster of that format. Throws TooLittleTexture, InputError where
// nutik-motion.so is not found (media/module.hpp).
[[nodiscard]] std::unique_ptr<Registrar> open_registrar(const CaptureFormat& format,
                                                        std::span<const std::byte> reference);

// What nutik-motion.so gives the program.
struct MotionModule {
  static constexpr const char* kFile = "nutik-motion.so";
  static constexpr const char* kSymbol = "nutik_motion_module";
  static constexpr const char* kWithout = "no camera's motion can be found";

  void (*use_shared_state)(SharedState& of_program);  // first
  decltype(&open_registrar) open;
  decltype(&open_flow_finder) open_flow;
};

// Whether most of the texture follows it.
[[nodiscard]] inline bool is_sure(const Registered& found) { return found.agreeing >= 0.5; }

// What a registrar of pictures of this format holds, with one search under way.
[[nodiscard]] MemoryNeeds registrar_needs(const CaptureFormat& format, Reach reach);
// What each further search at the same time takes.
[[nodiscard]] std::uint64_t registered_bytes(const CaptureFormat& format);

}  // namespace nutik
