// How a capture is read: what is stated about a clip, which goes before what its files say, and what is held of it.
// A value: two are equal when they ask for the same.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "align/camera_path.hpp"
#include "capture/noise_model.hpp"
#include "capture/timeline.hpp"
#include "imev/tile_cost.hpp"
#include "media/clip.hpp"
#include "session/shared.hpp"
#include "session/stated_time.hpp"

namespace nutik {

// The camera's noise: none that is known, measured on the clip itself, or stated.
struct NoNoise {
  friend bool operator==(const NoNoise&, const NoNoise&) = default;
};
struct NoiseOfClip {
  friend bool operator==(const NoiseOfClip&, const NoiseOfClip&) = default;
};
struct StatedNoise {
  std::string name;  // for messages: a file's
  CameraNoise noise;
  friend bool operator==(const StatedNoise&, const StatedNoise&) = default;
};

// A moment of a clip, as it was stated. Throws UsageError naming `what` where pictures are not counted in whole ones.
[[nodiscard]] ClipMoment clip_moment(const StatedTime& time, std::string_view what);

// What becomes of places that not every aligned picture saw: they are cut away, or hold what was seen there before.
enum class Unseen { cropped, held };

// Moving each picture onto one of them, so that the camera stands still.
struct AlignRequest {
  CameraMotion motion = CameraMotion::rigid;
  std::optional<StatedTime> reference;     // none: the first picture
  std::optional<Shared<CameraPath>> path;  // one that is known already; it says motion and reference itself
  Unseen unseen = Unseen::cropped;
  friend bool operator==(const AlignRequest&, const AlignRequest&) = default;
};

struct SourceRequest {
  std::filesystem::path path;  // a .tik, a video, a sequence of stills or a table of them
  ClipOptions clip;
  std::optional<Rational>
      shutter_angle;  // degrees; none: as listed in the files, else Timeline::kFullShutter

  std::optional<AlignRequest> align;
  bool deflickered = false;  // media/deflicker.hpp, of pictures that are aligned

  // What counts as no change.
  std::uint32_t tolerance = 0;  // codes
  std::variant<NoNoise, NoiseOfClip, StatedNoise> noise;
  double sigmas = NoiseModel::kUsualSigmas;  // of the camera's noise

  TilePolicy tiles = TilePolicy::automatic;
  std::optional<std::uint32_t> block_samples;  // none: as many as blocks of a handy size hold

  // Whether something is stated that holds for clips only. A .tik was described when it was made.
  [[nodiscard]] bool describes_clip() const;

  friend bool operator==(const SourceRequest&, const SourceRequest&) = default;
};

}  // namespace nutik
