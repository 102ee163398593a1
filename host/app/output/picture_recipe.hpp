// The recipe of what `expose` makes, as the picture keeps it.
#pragma once

#include <future>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "app/command_line/options.hpp"
#include "session/pictures.hpp"

namespace nutik::app {

// What the recipe of one of many pictures states in place of the command's options.
struct OwnRecipe {
  std::map<std::string, std::optional<std::string>> options;  // by long names; none: left out
  std::optional<Recipe::Text> functions;
};

class PictureRecipe {
 public:
  // Reads the checksums of capture and mask beside whatever the caller does next; `options` must outlive
  // this. A capture that is exposed many times may be known by its checksum already. With --no-recipe it
  // does nothing.
  explicit PictureRecipe(const Options& options, std::optional<std::string> known_capture = {});

  // The recipe's text, for a picture that was computed in this precision; empty with --no-recipe. Of many
  // pictures, each one's is that of a single picture, with what is its own. Throws InputError where an input cannot
  // be read, or the text is longer than a picture carries (kMostPictureTextBytes).
  [[nodiscard]] std::string text(const std::string& precision, const OwnRecipe& own = {});

 private:
  const Options& options_;
  std::future<Recipe> reading_;
  std::optional<Recipe> recipe_;  // once it was read
};

// Whether a recipe may state this option of `expose` with this value: it makes the picture, and stands in no
// other place of the recipe.
[[nodiscard]] bool is_recipe_option(std::string_view long_name, std::string_view value);

// What the content of a capture is known by again: of a .tik its blocks' and footer's checksums.
[[nodiscard]] std::string capture_checksum(const std::string& path);

}  // namespace nutik::app
