// What a recipe keeps of the command line.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "app/command_line/options.hpp"
#include "session/picture_recipe.hpp"

namespace nutik::app {

// For the pictures of a command; none with --no-recipe. A capture that is exposed many times may be known by its
// checksum already. Throws InputError where functions, noise or mask cannot be read.
[[nodiscard]] std::optional<RecipeSources> recipe_sources(const Options& options,
                                                          std::optional<std::string> capture_checksum = {});

// Whether a recipe may state this option of `expose` with this value: it makes the picture, and stands in no
// other place of the recipe.
[[nodiscard]] bool is_recipe_option(std::string_view long_name, std::string_view value);

}  // namespace nutik::app
