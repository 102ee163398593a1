// What --skip-existing needs, and says.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "session/schema/options.hpp"

namespace nutik::app {

// Throws UsageError where a picture of that name would carry no recipe to be known by.
void require_recipes(const Options& options, const std::filesystem::path& picture);

// The arithmetic that was asked for; none for `auto`.
[[nodiscard]] std::optional<std::string> stated_precision(const Options& options);

// That all of so many `things` are there. Returns the exit status.
int tell_all_made(const Options& options, const std::filesystem::path& output, std::size_t count,
                  std::string_view thing);

}  // namespace nutik::app
