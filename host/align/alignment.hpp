// Clips whose camera moved, as if it had stood still: each picture is moved onto one of them.
//
//   in:      a clip, which is read twice: once for how the camera moved, once for its pictures
//   out:     a clip of the pictures moved back, and the camera's path
//   always:  pictures are moved in light (align/light_warp.hpp), by what was found of each alone: nothing drifts
#pragma once

#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "align/camera_path.hpp"
#include "capture/error.hpp"
#include "capture/light_codes.hpp"
#include "capture/memory_needs.hpp"
#include "media/clip.hpp"
#include "system/interruption.hpp"
#include "system/shared.hpp"
#include "tik/header.hpp"
#include "tik/reader.hpp"

namespace nutik {

// A clip's pictures do not lie on each other, whatever is tried.
struct CannotAlign : InputError {
  using InputError::InputError;
  std::optional<std::uint64_t> picture = std::nullopt;  // the first that shows too little of what the reference does
  CameraMotion motion = CameraMotion::automatic;        // by which all pictures before it were found
};

struct ClipToAlign {
  std::string name;
  CaptureFormat format;  // of its samples, as they are or as they were stated
  std::uint64_t announced_samples = 0;  // 0: they are not
  std::uint64_t decoder_bytes = 0;
  OpenClip open;
  std::uint64_t reference = 0;  // the picture that others are moved onto
};

[[noreturn]] void refuse_above_white(const std::string& name, std::uint64_t picture, const CodeAboveWhite& error);

// Reads all of the clip; `progress` counts its pictures. Throws CannotAlign, MemoryTooLittle, Cancelled, InputError
// where the clip ends before the reference.
[[nodiscard]] CameraPath find_camera_path(const ClipToAlign& clip, CameraMotion motion,
                                          std::uint64_t memory_bytes, const ReportedProgress& progress,
                                          const std::stop_token& stop);

// What of the reference the aligned pictures show. Throws CannotAlign where nothing is left.
[[nodiscard]] Rectangle shown_area(const std::string& name, const CameraPath& path, Unseen unseen);

// The pictures, moved along the path. Throws InputError where the path is that of pictures of another size; read()
// where the clip has more pictures than it.
[[nodiscard]] std::unique_ptr<Clip> open_aligned(const ClipToAlign& clip, const Shared<CameraPath>& path,
                                                 Unseen unseen);

// `aligned to picture 0 (rigid), from which others are …`, how well that holds, and what is left of the pictures.
[[nodiscard]] std::string alignment_text(const CameraPath& path, const Rectangle& area, Unseen unseen);

// The same as a capture keeps it, and in words.
[[nodiscard]] tik::Alignment kept_alignment(const CameraPath& path, Unseen unseen);
[[nodiscard]] std::string alignment_text(const tik::Alignment& aligned);

// How the camera of a capture moved that was taken for a resting one, or that this could not be told.
struct MovedCamera {
  double pixels = 0;  // of the place that moved furthest; 0: untold
  double degrees = 0;
  std::uint64_t sample = 0;  // at which, from the first sample
  std::uint64_t looks = 0, unsure = 0;  // samples, and those that may have moved further: they could not be compared
  double seemingly_pixels = 0;          // where that is untold
  [[nodiscard]] bool is_untold() const { return pixels == 0; }
  // `the camera moved: …`
  [[nodiscard]] std::string text() const;
};

// Compares a few pictures with the first of them. Nothing where little of that has texture; untold where half of them
// or more follow no motion of a camera.
class CameraLooks {
 public:
  explicit CameraLooks(const CaptureFormat& format) : format_(format) {}

  // How the camera surely moved so far.
  const std::optional<MovedCamera>& look(std::uint64_t sample, std::span<const std::byte> raster);
  [[nodiscard]] std::optional<MovedCamera> moved() const;

 private:
  CaptureFormat format_;
  std::unique_ptr<Registrar> registrar_;
  std::optional<MovedCamera> moved_;
  double seemingly_ = 0;
  std::uint64_t looks_ = 0, unsure_ = 0;
};

// What a look takes, beside blocks of the capture.
[[nodiscard]] MemoryNeeds camera_check_needs(const CaptureFormat& capture);

// CameraLooks of samples all along; nothing of a capture whose pictures were aligned. Throws InputError where the
// capture is damaged.
[[nodiscard]] std::optional<MovedCamera> moved_camera(tik::Reader& capture);

}  // namespace nutik
