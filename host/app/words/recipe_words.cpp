#include "app/words/stated_requests.hpp"

#include <algorithm>

#include "capture/format.hpp"
#include "features/schema/option.hpp"
#include "media/input_checksum.hpp"
#include "media/writers/recipe.hpp"
#include "session/requests/named_inputs.hpp"
#include "session/text/shell_text.hpp"
#include "system/input_bytes.hpp"

namespace nutik::app {
namespace {

// Files have a place of their own in a recipe, with their text or checksum.
bool is_stated(const Option& option, std::string_view value, RecipeOf of) {
  return option.is_of(find_command(to_text(of))->id) && option.is_flag() == value.empty() &&
         (of == RecipeOf::expose ? option.makes_picture() : option.makes_sheet()) &&
         (!option.reads_file() || option.knows(value));
}

// What came from standard input gets a name that a file can have.
std::string known_name(const std::string& name, const char* extension) {
  return is_standard_input(name) ? std::string("standard-input") + extension : input_name(name);
}

Recipe::Text whole_text(const std::string& name, const char* extension) {
  return {known_name(name, extension), std::string(InputBytes(name).text())};
}

}  // namespace

bool is_recipe_option(std::string_view long_name, std::string_view value, RecipeOf of) {
  return std::ranges::any_of(schema(), [&](const Option& option) {
    return option.is_called(long_name) && is_stated(option, value, of);
  });
}

std::optional<RecipeSources> recipe_sources(const Options& options, RecipeOf of) {
  if (options.no_recipe) return std::nullopt;
  RecipeSources sources{{}, options.operands.front(), {}};
  Recipe& recipe = sources.made;
  recipe.version = NUTIK_VERSION;
  recipe.of = of;
  if (options.functions) recipe.functions = whole_text(*options.functions, ".fn");
  if (options.noise && *options.noise != kAutomaticNoise) recipe.noise = whole_text(*options.noise, ".noise");
  if (options.mask) {
    recipe.mask = Recipe::Input{known_name(*options.mask, ".pgm"), mask_checksum(*options.mask)};
  }
  if (options.mask_to) {
    recipe.mask_to = Recipe::Input{input_name(*options.mask_to), mask_checksum(*options.mask_to)};
  }
  for (const Option& option : schema()) {
    static const std::string kFlag;
    const std::string* value = option.is_flag() && option.is_in(options) ? &kFlag : option.stated(options);
    if (value != nullptr && is_stated(option, *value, of))
      recipe.options.emplace_back(option.long_name, *value);
  }
  if (const auto& delay = options.asked.delay; delay && !delay->file.empty()) {
    recipe.delay_map = Recipe::Input{input_name(delay->file), input_checksum(delay->file)};
    std::ranges::find(recipe.options, "delay", &std::pair<std::string, std::string>::first)->second =
        delay->range_text();
  }
  std::ranges::sort(recipe.options, {}, [&](const auto& option) {
    const auto said = std::ranges::find(options.said, option.first, &Said::option);
    return std::pair(of == RecipeOf::expose ? 0 : said - options.said.begin(), option.first);
  });
  recipe.renderer = options.text("renderer", "opencl");
  return sources;
}

OwnRecipe own_recipe(const OwnExposure& exposure) {
  // Normalized and brightened already.
  OwnRecipe own{{{"gain", {}}, {"ev", {}}, {"normalize", {}}}, {}};
  if (const auto* text = std::get_if<Recipe::Text>(&exposure)) {
    own.functions = *text;
    for (const char* name : {"start", "exposure", "shutter", "shutter-error"}) own.options[name] = {};
    return own;
  }
  const auto& [start, length, gain] = std::get<OwnInterval>(exposure);
  own.options["start"] = start.text();
  own.options["exposure"] = length.text();
  if (gain != 1.0) own.options["gain"] = format("{}", gain);
  return own;
}

std::string stated_words(const Options& options, CommandId command) {
  std::string words;
  for (const Option& option : schema()) {
    const bool counts = option.makes_picture() || option.scope == Scope::computing;
    if (!counts || !option.is_of(command) || !option.is_in(options)) continue;
    words += " " + option.name();
    if (const std::string* const value = option.stated(options)) words += " " + shell_word(*value);
  }
  return words;
}

}  // namespace nutik::app
