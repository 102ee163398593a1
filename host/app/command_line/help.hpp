// Help, from the one table of commands and options, and the texts that other pages share with it.
#pragma once

#include <string>
#include <string_view>

#include "app/command_line/command_table.hpp"
#include "features/schema/option.hpp"

#ifndef NUTIK_VERSION
#error "NUTIK_VERSION is not set"
#endif

namespace nutik::app {

// What every page starts with, for people who never heard of it.
inline constexpr std::string_view kWhatItIs =
    "nutik-cl exposes pictures after the scene was filmed. It turns a video into a capture (.tik), the "
    "record of when and how every pixel changed, and exposes pictures from it in which every region of a "
    "mask has its own gain as a function of time.";
inline constexpr std::string_view kAboutFunctionFiles =
    "A function file has a line for each mask value, with times in nanoseconds:";
inline constexpr std::string_view kFunctionFile = "M0 [0:1], [10000000:1], [10000001:0]";

// The first sentence of a summary, with its full stop, without what a colon adds and without a default.
[[nodiscard]] std::string brief(std::string_view summary);

void print_help();
void print_command_help(const Command& command);
void print_version();

}  // namespace nutik::app
