// How a capture is read: what a person states about a clip, which overrides what its files say, and which changes are
// kept. A value: two are equal when they ask for the same.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "align/between.hpp"
#include "align/camera_path.hpp"
#include "capture/noise_model.hpp"
#include "capture/timeline.hpp"
#include "imev/tile_cost.hpp"
#include "media/clip.hpp"
#include "session/requests/stated_moments.hpp"
#include "system/shared.hpp"

namespace nutik {

// The camera's noise: unknown, measured on the clip itself, or stated.
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

// A moment of a clip, as it was stated. Throws UsageError naming `what` if it is a fraction of a picture.
[[nodiscard]] ClipMoment clip_moment(const StatedTime& time, std::string_view what);

// Moves each picture onto one of them, as if the camera had stood still.
struct AlignRequest {
  CameraMotion motion = CameraMotion::rigid;
  std::optional<StatedTime> reference;     // none: the first picture
  std::optional<Shared<CameraPath>> path;  // known already; replaces motion and reference
  Unseen unseen = Unseen::cropped;
  friend bool operator==(const AlignRequest&, const AlignRequest&) = default;
};

struct SourceRequest {
  std::filesystem::path path = {};  // a .tik, or whatever open_clip() opens
  ClipOptions clip = {};
  // Degrees; none: as listed in the files, else Timeline::kFullShutter.
  std::optional<Rational> shutter_angle = std::nullopt;

  std::optional<AlignRequest> align = std::nullopt;
  bool deflickered = false;  // media/deflicker.hpp, of pictures that are aligned
  std::optional<BetweenRequest> between = std::nullopt;  // of these

  // What counts as no change.
  std::uint32_t tolerance = NoiseModel().tolerance;  // codes
  std::variant<NoNoise, NoiseOfClip, StatedNoise> noise = {};
  static constexpr double kMinSigmas = 0.1, kMaxSigmas = 100;
  double sigmas = NoiseModel::kDefaultSigmas;  // of the camera's noise

  TilePolicy tiles = TilePolicy::automatic;
  std::optional<std::uint32_t> block_samples = std::nullopt;  // none: as many as fit a block of usual size

  // Whether anything is stated that only a clip can have. A .tik was described when it was made.
  [[nodiscard]] bool describes_clip() const;

  friend bool operator==(const SourceRequest&, const SourceRequest&) = default;
};

// Whether a file is read as a .tik: told from its content, else from its name. Of standard input it is told once all of
// it is there.
[[nodiscard]] bool is_tik(const std::filesystem::path& path);

}  // namespace nutik
