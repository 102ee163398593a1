// What a clip's times were taken from, for people.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "session/requests/source_request.hpp"

namespace nutik::app {

// `120 pictures a second (--fps), shutter 180 degrees (--shutter-angle)`: what times were made from.
[[nodiscard]] std::string timing_text(std::span<const Fact> facts);

// `source: …` with that, where there is any, and `colour: …` with the other facts and the options that change what is assumed.
[[nodiscard]] std::vector<std::string> fact_lines(std::span<const Fact> facts);

}  // namespace nutik::app
