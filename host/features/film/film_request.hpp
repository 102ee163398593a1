// A video, as it is asked for: when its frames are exposed, and how.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "capture/frame_times.hpp"
#include "capture/rational.hpp"
#include "features/series/series_request.hpp"
#include "mask/feather.hpp"
#include "mask/mask_between.hpp"
#include "session/memory_budget.hpp"
#include "session/requests/exposure_request.hpp"
#include "session/requests/stated_moments.hpp"

namespace nutik {

// Speed curves: which time of the capture each time of a film shows.
//
//   in:      points, a time of the film and one of the capture each; between them the curve is a straight line
//   out:     when the frames are exposed: speed ramps, backwards, frozen
//   always:  a frame's exposure follows from its number alone. It lies in the capture and is never empty
struct FilmCurve {
  struct Point {
    std::int64_t film_ns = 0;
    StatedTime capture;
  };
  std::string name;           // of the file, for messages
  std::vector<Point> points;  // two or more; film times begin at 0 and increase

  // A line for each point, `1.5s,0.4s`: the film's time, or `36f` for the start of its frame 36, and the capture's, or
  // `37f` for that of picture 37. Empty lines count for nothing, nor does what follows a `#`. Throws InputError
  // with the line of what is wrong.
  static FilmCurve parse(std::string_view text, const std::string& title, const FrameTimes& film);
};

// A curve on a capture.
class CapturedCurve {
 public:
  // `min_ns` is how long a frame is exposed at least, above 0. Throws UsageError where a point names a picture that is
  // not there.
  CapturedCurve(const FilmCurve& curve, const Timeline& timeline, std::int64_t min_ns);

  // What the curve passes while a shutter is open, from its earliest to its latest time, before it is cut to the
  // capture. `film` may go on behind the curve's end, where its last time holds.
  [[nodiscard]] Exposure passed(const Exposure& film) const;
  // The part of that in the capture, and where that is shorter than the least, the nearest that is so long.
  [[nodiscard]] Exposure exposure(const Exposure& film) const;
  // Whether the curve leaves the capture while the shutter is open.
  [[nodiscard]] bool leaves(const Exposure& film) const;

  // Where the curve is at a time of the film.
  [[nodiscard]] std::int64_t time_ns(std::int64_t film_ns) const;
  [[nodiscard]] std::int64_t film_end_ns() const { return points_.back().film_ns; }

 private:
  struct Point {
    std::int64_t film_ns, capture_ns;
  };
  std::vector<Point> points_;
  std::int64_t duration_ns_, min_ns_;
};

// Functions and masks that change along a film: what they are at key frames, and between them.
//
//   in:      keys, in nanoseconds of the film from its first frame on
//   out:     the functions and the mask of any moment of the film
//   always:  before the first key and after the last the nearest one holds. A moment's functions and mask follow from
//            that moment alone, so that every frame is an exposure of its own
struct FunctionKey {
  std::int64_t film_ns = 0;
  std::string name;  // of the file, for messages
  Shared<FunctionSet> functions;
};

struct MaskKey {
  std::int64_t film_ns = 0;
  std::string name;
  std::string checksum;  // as recipes know it
  Shared<Mask> mask;     // without a feather
};

// Between masks[key] and the next, `way` of kWholeWay from the first.
struct MaskMoment {
  std::size_t key = 0;
  std::uint32_t way = 0;  // below kWholeWay
};

struct KeyFrames {
  std::vector<FunctionKey> functions;  // none: those of the exposure
  std::vector<MaskKey> masks;          // none: that of the exposure
  MaskBlend blend = MaskBlend::distance;
  std::optional<Feather> feather;  // of all masks

  [[nodiscard]] bool empty() const { return functions.empty() && masks.empty(); }

  // Throws UsageError where there is only one key of a kind, or one is not after the one before it or before the film;
  // InputError where functions are for other mask values than those of the first key, or masks do not blend.
  void check() const;

  [[nodiscard]] FunctionSet functions_at(std::int64_t film_ns) const;
  [[nodiscard]] MaskMoment mask_moment(std::int64_t film_ns) const;
  [[nodiscard]] Mask mask_at(std::int64_t film_ns) const;

  // `exposure` with the functions and the mask of a moment, where there are keys of them.
  [[nodiscard]] ExposureRequest exposure_at(std::int64_t film_ns, const ExposureRequest& exposure) const;
};

// The mask between two, with its edges blended: by distance after the edges moved, by alpha before one fades into the
// other. Throws what mask_between() and feathered() do.
[[nodiscard]] Mask blended_mask(const Mask& a, const std::string& a_name, const Mask& b,
                                const std::string& b_name, MaskBlend blend, std::uint32_t way,
                                const std::optional<Feather>& feather);

// A moment of a film: in seconds, or by the number of a frame, whose start it is. Throws UsageError naming `what` where
// that is before the film.
[[nodiscard]] std::int64_t film_moment_ns(const StatedTime& time, const std::string& what,
                                          const FrameTimes& film);

// What of the clip's sound goes with the film: as it is, if the film runs as fast as the file; as slow or fast as the
// film.
enum class FilmSoundWish { as_it_is, stretched, none };

struct FramesRequest {
  // Exposes every frame, from the frame's start on: its own start and length say nothing.
  ExposureRequest exposure;
  Rational rate{24, 1};    // frames a second of playback
  Rational speed{1, 1};    // seconds of the capture for each second of playback
  Rational angle{180, 1};  // of the shutter, in degrees of a frame; not of functions
  StatedTime from;
  std::optional<StatedTime> to;        // none: the capture's end
  std::optional<FilmCurve> curve;      // in place of from, to and speed
  KeyFrames keys;                      // of functions: in place of those of the exposure; of masks likewise
  std::optional<FrameRanges> numbers;  // of the frames to make; none: all

  // `24 frames a second, 180 degrees, speed 0.25`.
  [[nodiscard]] std::string text() const;
  // When the frames are exposed in the film's own time, from 0 on.
  [[nodiscard]] FrameTimes film_times() const { return {{}, rate, {1, 1}, angle}; }
};

// The frames of a video of one capture.
struct Frames {
  FrameTimes times;
  std::uint64_t count;                 // of the whole film
  std::string warning;                 // a sentence; empty where all is well
  std::vector<std::uint64_t> numbers;  // of the frames to make, in order: at least one
  std::optional<CapturedCurve> curve = {};
  std::optional<FrameTimes> film = {};  // where a curve or keys need the film's own time
  std::optional<std::int64_t> functions_ns = {};  // how long functions expose from a frame's start on

  // When a frame is exposed, on the capture.
  [[nodiscard]] Exposure exposure(std::uint64_t frame) const {
    return curve ? curve->exposure(film->exposure(frame)) : times.exposure(frame);
  }
  // From the earliest to the latest time that one of the frames to make is exposed.
  [[nodiscard]] Exposure span() const;
};

// What a frame is exposed with: the request's exposure, with the functions and the mask of that moment of the film.
[[nodiscard]] ExposureRequest exposure_of(const FramesRequest& request, const Frames& frames,
                                          std::uint64_t frame);

// The samples of a clip that the film is exposed from, if a quarter of its frames or more are exposed from two or three
// of them: such a frame shows what moves two or three times. More of them join to a blur.
[[nodiscard]] std::optional<SampleRange> seen_together(const Frames& frames, const Timeline& timeline);

// Throws UsageError where the capture has none, none of them is to be made, or times make no sense.
[[nodiscard]] Frames frames_of(const FramesRequest& request, const Timeline& timeline);

// Memory for a video's frames beside the renderer: those that wait, one that is converted for the encoder, and
// `encoder_frames` that the encoder keeps.
[[nodiscard]] NeedsOfFormat video_needs(std::uint32_t encoder_frames,
                                        const std::function<ValueType(const CaptureFormat&)>& type_of);

}  // namespace nutik
