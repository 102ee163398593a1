// The recipe of a picture, made from what an exposure was asked for with.
#pragma once

#include <future>
#include <map>
#include <optional>
#include <string>

#include "capture/error.hpp"
#include "capture/timeline.hpp"
#include "media/writers/recipe.hpp"

namespace nutik {

// What the pictures of a command have in common.
struct RecipeSources {
  Recipe made;                                  // without the capture's checksum and the precision
  std::string capture;                          // the clip or .tik itself: a path
  std::optional<std::string> capture_checksum;  // where it is known already
};

// What the recipe of one of many pictures states in place of that.
struct OwnRecipe {
  std::map<std::string, std::optional<std::string>> options;  // by long names; none: left out
  std::optional<Recipe::Text> functions = {};
  std::optional<Recipe::Input> mask = {}, mask_to = {};
};

// What a frame of a video adds to the recipe of a single picture: when it was exposed; with functions, their time 0.
[[nodiscard]] OwnRecipe own_recipe(const Exposure& exposure, bool is_plain);

class PictureRecipe {
 public:
  // Reads the capture's checksum beside whatever the caller does next. Without sources there are no recipes.
  explicit PictureRecipe(std::optional<RecipeSources> sources);

  // The recipe's text for a picture computed in this precision, with what is its own, what its arithmetic may be off
  // by, and the map that says so; empty without sources. Throws InputError where the capture cannot be read
  // or the text is larger than a picture carries.
  [[nodiscard]] std::string text(const std::string& precision, const OwnRecipe& own = {},
                                 const std::string& error_bound = {},
                                 const std::optional<Recipe::Input>& bounds_map = {});

 private:
  std::future<Recipe> reading_;
  std::optional<Recipe> recipe_;  // once it was read
};

// What the content of a capture is known by again, read as the recipe's options say: of a .tik its blocks' and
// footer's checksums.
[[nodiscard]] std::string capture_checksum(const std::string& path, const Recipe& recipe);

}  // namespace nutik
