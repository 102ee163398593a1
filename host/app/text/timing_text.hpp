// What a clip's times were taken from, for people.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "session/capture.hpp"
#include "session/source_request.hpp"

namespace nutik::app {

// `120 pictures a second (--fps), shutter 180 degrees (--shutter-angle)`: what a timeline was made from.
[[nodiscard]] std::string timing_text(const Timeline& timeline, const SourceRequest& request);

// What else a person should know of a clip, as lines: the `notes` on it, and that a low rate from a file may not be the
// rate it was filmed with.
[[nodiscard]] std::vector<std::string> note_lines(std::span<const Note> notes, const Timeline& timeline,
                                                  const SourceRequest& request);

}  // namespace nutik::app
