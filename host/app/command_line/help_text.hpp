// Texts that help, the manual page and completion share.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace nutik::app {

// What every page starts with, for people who never heard of it.
inline constexpr std::string_view kWhatItIs =
    "nutik-cl exposes pictures after the scene was filmed. It turns a video into a capture (.tik), the "
    "record "
    "of when and how every pixel changed, and exposes pictures from it in which every region of a mask has "
    "its "
    "own gain as a function of time.";

// The first sentence of a summary, with its full stop, without what a colon adds and without a default.
[[nodiscard]] std::string brief(std::string_view summary);

// The lines of a text.
[[nodiscard]] std::vector<std::string_view> lines_of(std::string_view text);

}  // namespace nutik::app
