// Speed curves: which time of the capture each time of a film shows.
//
//   in:      points, a time of the film and one of the capture each; between them the curve is a straight line
//   out:     when the frames are exposed: speed ramps, backwards, frozen
//   always:  a frame's exposure follows from its number alone. It lies in the capture and is never empty
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "capture/frame_times.hpp"
#include "session/requests/stated_time.hpp"

namespace nutik {

struct FilmCurve {
  struct Point {
    std::int64_t film_ns = 0;
    StatedTime capture;
    friend bool operator==(const Point&, const Point&) = default;
  };
  std::string name;           // of the file, for messages
  std::vector<Point> points;  // two or more; film times begin at 0 and increase

  // A line for each point, `1.5s,0.4s`: the film's time, or `36f` for the start of its frame 36, and the capture's, or
  // `37f` for that of picture 37. Empty lines count for nothing, nor does what follows a `#`. Throws InputError
  // with the line of what is wrong.
  static FilmCurve parse(std::string_view text, const std::string& title, const FrameTimes& film);

  friend bool operator==(const FilmCurve&, const FilmCurve&) = default;
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

}  // namespace nutik
