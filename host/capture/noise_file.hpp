// A camera's noise as text, which a person can read, edit and plot:
//
//   nutik noise 0
//   white 255
//   transfer srgb
//   channel red
//   read 0.0021          standard deviation in light where there is none
//   shot 0.00012         variance in light for each unit of light
//   curve sensor         what is used: sensor (the two lines above) or points (those below)
//   point 12.5 1.32 5021     code, standard deviation in codes, pixels it was measured on
//   …
//
// A line is a key and its values, between blanks; `#` begins a comment; empty lines are skipped. The first
// three lines come in this order, then the channels: grey, or red, green and blue.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "capture/noise_model.hpp"

namespace nutik {

inline constexpr std::size_t kMaxNoisePoints = 256;  // of a channel

// Throws InputError with every mistake as `name:line:column: what is wrong`, one below the other.
[[nodiscard]] CameraNoise parse_noise(std::string_view bytes, const std::string& name);

// The lines of the file, without line ends or comments. Numbers have the digits that give them back exactly.
[[nodiscard]] std::vector<std::string> noise_lines(const CameraNoise& noise);

// The file as it is written for people: noise_lines() with a comment on what each means.
[[nodiscard]] std::string noise_text(const CameraNoise& noise, std::span<const std::string> comments);

}  // namespace nutik
