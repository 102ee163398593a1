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
    "A function file has a line for each mask value, with times in nanoseconds or with a unit:";
inline constexpr std::string_view kFunctionFile = "M0 [0:1], [10ms:1], [10000001:0]";

// What a summary begins with: up to its first colon, semicolon, bracket or full stop.
[[nodiscard]] std::string brief(std::string_view summary);

[[nodiscard]] bool is_help_topic(std::string_view name);  // all, source, computing, output

void print_help();
// In 40 lines of 80 columns what sets the command apart; with a topic (all, source, computing, output) all that is said
// of those options. Throws UsageError for another topic.
void print_command_help(const Command& command, std::string_view topic);
void print_version();

}  // namespace nutik::app
