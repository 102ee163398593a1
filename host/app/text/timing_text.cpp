#include "app/text/timing_text.hpp"

#include "app/text/message_text.hpp"
#include "session/format.hpp"
#include "session/time_text.hpp"

namespace nutik::app {
namespace {

// Rates from the one to the other are what players show; a clip filmed faster often says one of them.
constexpr double kLowestPlaybackRate = 1.0;
constexpr double kHighestPlaybackRate = 60.0;

}  // namespace

std::string timing_text(const Timeline& timeline, const SourceRequest& request) {
  const std::string rate =
      request.clip.rate ? rate_text(timeline.rate(), "picture") + " (--fps)"
      : timeline.is_constant()
          ? rate_text(timeline.rate(), "picture") + " (from the file)"
          : format("irregular times (from the file), {} on average", rate_text(timeline.rate(), "picture"));
  return format("{}, shutter {} degrees ({})", rate, timeline.shutter_angle().text(),
                request.shutter_angle                                ? "--shutter-angle"
                : timeline.shutter_angle() != Timeline::kFullShutter ? "mean of the listed exposures"
                                                                     : "assumed");
}

std::vector<std::string> note_lines(std::span<const Note> notes, const Timeline& timeline,
                                    const SourceRequest& request) {
  std::vector<std::string> lines;
  for (const Note& note : notes) lines.push_back(note_text(note));
  const double rate = timeline.rate().value();
  if (!request.clip.rate && rate >= kLowestPlaybackRate && rate <= kHighestPlaybackRate) {
    lines.push_back(format(
        "note: the rate of {} a second comes from the file; slow-motion files state their playback rate: "
        "if it was filmed faster, say so with --fps",
        timeline.rate().text()));
  }
  return lines;
}

}  // namespace nutik::app
