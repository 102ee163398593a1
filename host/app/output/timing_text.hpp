// What a clip was taken for, and who said so, for people.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "session/requests/source_request.hpp"

namespace nutik::app {

// `120 pictures a second (--fps), shutter 180 degrees (--shutter-angle)`: what times were made from.
[[nodiscard]] std::string timing_text(std::span<const Fact> facts);

// A line each, where there are facts: source: (times), part:, events:, colour: with the options that change what is
// assumed.
[[nodiscard]] std::vector<std::string> fact_lines(std::span<const Fact> facts);

}  // namespace nutik::app
