#include "features/recipe/picture_recipe.hpp"

#include <algorithm>

#include "capture/format.hpp"
#include "media/input_checksum.hpp"
#include "media/stills/picture_text.hpp"
#include "session/clips/clip_source.hpp"
#include "session/requests/stated_moments.hpp"
#include "tik/reader.hpp"

namespace nutik {

std::string capture_checksum(const std::string& path, const Recipe& recipe) {
  const bool is_raw = std::ranges::any_of(recipe.options, [](const auto& option) { return option.first == "raw"; });
  if (!is_tik(path)) return input_checksum(path, is_raw);
  return format("xxh3-64-tik:{:016x}", tik::Reader(path).content_checksum());
}

OwnRecipe own_recipe(const Exposure& exposure, bool is_plain) {
  OwnRecipe own{{{"start", StatedTime::of_nanoseconds(exposure.start_ns).text()}}, {}};
  if (is_plain) {
    own.options["exposure"] = StatedTime::of_nanoseconds(exposure.end_ns - exposure.start_ns).text();
  }
  return own;
}

PictureRecipe::PictureRecipe(std::optional<RecipeSources> sources) {
  if (!sources) return;
  reading_ = std::async(std::launch::async, [known = std::move(*sources)] {
    Recipe recipe = known.made;
    recipe.capture = {input_name(known.capture),
                      known.capture_checksum ? *known.capture_checksum : capture_checksum(known.capture, recipe)};
    return recipe;
  });
}

std::string PictureRecipe::text(const std::string& precision, const OwnRecipe& own,
                                const std::string& error_bound,
                                const std::optional<Recipe::Input>& bounds_map) {
  if (reading_.valid()) recipe_ = reading_.get();
  if (!recipe_) return {};
  Recipe recipe = *recipe_;
  recipe.precision = precision;
  recipe.error_bound = error_bound;
  recipe.bounds_map = bounds_map;
  if (own.functions) recipe.functions = own.functions;
  if (own.mask) recipe.mask = own.mask;
  if (own.mask_to) recipe.mask_to = own.mask_to;
  for (const auto& [name, value] : own.options) {
    std::erase_if(recipe.options, [&name = name](const auto& option) { return option.first == name; });
    if (value) recipe.options.emplace_back(name, *value);
  }
  if (!own.options.empty()) std::ranges::sort(recipe.options);
  std::string text = recipe.text();
  if (text.size() >= kMaxPictureTextBytes) {
    throw InputError(format("the recipe has {} bytes and a picture carries {} MiB at most", text.size(),
                               kMaxPictureTextBytes >> 20),
                     Advice{"; leave it out: `no-recipe`"});
  }
  return text;
}

}  // namespace nutik
