// What a clip's times were taken from, for people.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "session/capture.hpp"
#include "session/source_request.hpp"

namespace nutik::app {

// `120 pictures a second (--fps), shutter 180 degrees (--shutter-angle)`: what times were made from.
[[nodiscard]] std::string timing_text(std::span<const Fact> facts);

// `source: …` with that, and `colour: …` with the other facts and the options that change what is assumed.
[[nodiscard]] std::vector<std::string> fact_lines(std::span<const Fact> facts);

// What else a person should know of a clip, as lines: the `notes` on it, and that a low rate from a file may not be the
// rate it was filmed with.
[[nodiscard]] std::vector<std::string> note_lines(std::span<const Note> notes, const Timeline& timeline,
                                                  const SourceRequest& request);

}  // namespace nutik::app
