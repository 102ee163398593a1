// Recipes: their text, and the pictures that carry it.
#include "capture/error.hpp"
#include "fuzz/target.hpp"
#include "media/writers/recipe.hpp"

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

// OpenEXR's header is read by the module of stills, which is large.
void load_stills() {
  constexpr std::byte kMagic[] = {std::byte{0x76}, std::byte{0x2f}, std::byte{0x31}, std::byte{0x01}};
  try {
    static_cast<void>(read_recipe(as_file(kMagic, "picture")));
  } catch (const Error&) {
  }
}

}  // namespace

const Target kTarget{{1 << 22, 4000}, read, load_stills};

}  // namespace nutik::fuzz
