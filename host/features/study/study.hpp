// A motion study: which moments of a subject a picture shows, and what between them; found in the capture.
//
//   in:      a style, how many moments or which
//   out:     what a mask, gain functions and an exposure are asked for: requests as a person would state them, so that
//            each can be changed by hand
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "capture/error.hpp"
#include "features/masks/mask_making.hpp"
#include "features/masks/mask_request.hpp"
#include "imev/capture_source.hpp"
#include "mask/feather.hpp"
#include "render/render_plan.hpp"
#include "scene/moments.hpp"
#include "scene/shots.hpp"
#include "scene/subject.hpp"
#include "session/memory_budget.hpp"
#include "session/requests/exposure_request.hpp"
#include "session/requests/stated_moments.hpp"
#include "system/interruption.hpp"

namespace nutik {

enum class StudyStyle {
  trail,         // sharp moments over the trail of the whole way
  strobe,        // sharp moments, and nothing between them
  rear_curtain,  // the last moment, and a trail that grows towards it
  frozen,        // one moment in a scene that is exposed for all of the time
  clean,         // the scene without what moves: its plate
  slit           // strips side by side, each at a moment of its own
};
// Where a slit's first moment lies: its strips are columns, or rows.
enum class SlitFrom { left, right, top, bottom };
enum class TrailShape { even, fade, ramp, none };

struct StudyRequest {
  StudyStyle style = StudyStyle::trail;
  std::variant<std::uint32_t, std::vector<StatedTime>> moments = std::uint32_t{5};  // else usual_moments(style)
  MomentSpacing spacing = MomentSpacing::time;
  std::optional<TrailShape> trail;  // none: what the style has
  SlitFrom slit_from = SlitFrom::left;
  // Each with a subject of its own, in pixels; none: one in all of the picture.
  std::vector<Rectangle> regions;
  // Only larger differences from the plate are the subject; none: than 1/16 of white, or than the noise.
  std::optional<std::uint32_t> by_codes;
  std::optional<Feather> feather;  // none: kStudyFeatherCentipixels, and none of a slit's strips
  // Where the trail would show the subject again and again, samples are made between the pictures of its way.
  bool joins_trail = false;
};

// There is no scene that rests.
struct EverythingMoves : InputError {
  explicit EverythingMoves(const std::string& message)
      : InputError(message, Advice{". A camera that moved stands still with `align rigid`; a fade, a dissolve or a "
                                   "title can be left out (`from`, `to`)"}) {}
};

// Regions that were stated hold no subjects of their own.
struct NoSubject : InputError {
  using InputError::InputError;
};

// A share of the picture, on average: more of it moves if the camera does.
inline constexpr double kMaxMoving = 0.2;

// What becomes of a scene of which most moves: it is refused, for the camera may have moved, or shown, for nothing
// helps against that.
enum class Unrest { refused, shown };

struct Study {
  // Samples, of one subject after another: of tags 1, 2, …; what is left has tag 0. Of a slit's strips: of tags 0, 1, …
  std::vector<std::uint64_t> moments;
  std::vector<std::size_t> subjects;  // whose each of them is: of which region, from 0. None of a slit
  // When nothing is at the place of each moment. What lies around the i-th then has tag moments.size() + i + 1, and
  // what is darker 2 moments.size() + i + 1.
  std::vector<SampleRange> grounds;
  bool are_moments_found = false;     // not stated
  // A long exposure, or a single moment, for what moves makes no more; a note says why.
  bool falls_short = false;
  double step_pixels = 0;   // that a subject goes from one sample to the next, where it goes on; a median
  double step_share = 0;    // of its size: of several subjects the one whose is largest
  double moving_share = 0;  // of the picture, that differs from the scene at rest on average
  MaskRequest mask;
  MadeMask regions;           // made as `mask` asks for them
  FunctionSet functions;      // as a function file has them, to be normalized by their integrals
  // The same where samples are made between the pictures: moments are so short that none of those is part of them.
  FunctionSet functions_between;
  SampleRange way;  // from where to where its trail goes, or that of lights that come and go
  double trail_strength = 1;  // how many times as strong the trail is as in a plain exposure
  SampleRange empty;          // at which nothing is there: taken away again from where the trail is stronger
  std::vector<std::string> notes;
};

// What lies around a subject, its shadow for example. A shadow dims the trail by as much as it dims the ground. What
// differs by less is an encoder's, a ring around what is bright, or a camera's that brightens all of the scene.
struct Around {
  double times;        // it differs from the plate by this many times the codes that a subject must differ by
  double trail_share;  // of the trail, that lies on it
};
inline constexpr std::array<Around, 2> kAround{{{1, 0.9}, {2.5, 0.4}}};

// How many moments a study shows, and strips a slit-scan: a mask has no more values.
inline constexpr std::uint32_t kMaxMoments = 50, kMaxStrips = 256;

// How many moments a style shows where nothing is stated.
[[nodiscard]] std::uint32_t usual_moments(StudyStyle style);

// Throws UsageError where what is stated does not go together, whatever the capture is.
void check_study(const StudyRequest& request);

// Looks at all of the capture, and makes the best picture of it that holds: where what moves cannot be shown as it was
// asked for, fewer moments, a single one, or a long exposure. Throws UsageError where moments are stated that do not go
// together; EverythingMoves; NoSubject; InputError where the capture is damaged; MemoryTooLittle.
[[nodiscard]] Study plan_study(CaptureSource& capture, const std::string& capture_name,
                               const StudyRequest& request, const MemoryBudget& memory,
                               const ReportedProgress& progress = {}, Unrest unrest = Unrest::refused);

// How far the subject's border is blended with what lies around it, in hundredths of a pixel: usually, and at most.
inline constexpr std::int32_t kStudyFeatherCentipixels = 200, kMaxStudyFeatherCentipixels = 3200;

// Whether anything of the subject's way is seen.
[[nodiscard]] bool has_trail(const StudyRequest& request);

// What exposes the study's picture through these regions.
[[nodiscard]] ExposureRequest study_exposure(const Study& study, const StudyRequest& request);

}  // namespace nutik
