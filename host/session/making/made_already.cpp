#include "session/making/made_already.hpp"

#include "capture/error.hpp"
#include "media/stills/picture_text.hpp"
#include "media/writers/recipe.hpp"

namespace nutik {

bool is_made(const std::filesystem::path& picture, const std::optional<std::string>& precision,
             const std::function<std::string(const std::string& precision)>& recipe_of) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(picture, error)) return false;
  try {
    const auto text = read_picture_text(picture);
    if (!text) return false;
    const Recipe recipe = Recipe::parse(*text, picture.string());
    if (precision && recipe.precision != *precision) return false;
    return recipe_of(recipe.precision) == *text;
  } catch (const InputError&) {
    return false;  // cut off, or no picture at all: whether it may be replaced is for check_output() to say
  }
}

}  // namespace nutik
