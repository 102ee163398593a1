// Help, from the one table of commands and options.
#pragma once

#include "app/command_line/option_table.hpp"

namespace nutik::app {

void print_help();
void print_command_help(const Command& command);
void print_version();

}  // namespace nutik::app
