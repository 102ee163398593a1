// Whether a picture is there already, as it would be made: told by the recipe that it carries, not by its name.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace nutik {

// Whether `picture` is a picture whose recipe is, byte for byte, the text that `recipe_of` makes for its precision: the
// same capture, functions, mask, options and version of the program. `precision`: the only one that counts; none: any,
// for `auto` is settled when a picture is computed. What carries no recipe, or cannot be read, is not made yet.
[[nodiscard]] bool is_made(const std::filesystem::path& picture, const std::optional<std::string>& precision,
                           const std::function<std::string(const std::string& precision)>& recipe_of);

}  // namespace nutik
