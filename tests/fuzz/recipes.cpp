// Recipes: their text, and the pictures that carry it.
#include "fuzz/target.hpp"
#include "media/recipe.hpp"

namespace nutik::fuzz {
namespace {

void read(Bytes input) {
  if (!input.empty() && input.front() == std::byte{'{'}) {
    const Recipe recipe = Recipe::parse(as_text(input), "recipe");
    const std::string text = recipe.text();
    demand(Recipe::parse(text, "again").text() == text, "a recipe is read from its text as it was");
    return;
  }
  static_cast<void>(read_recipe(as_file(input, "picture")));
}

}  // namespace

const Target kTarget{{1 << 22, 4000}, read};

}  // namespace nutik::fuzz
