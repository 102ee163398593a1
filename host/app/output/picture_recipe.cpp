#include "app/output/picture_recipe.hpp"

#include <algorithm>
#include <string_view>

#include "app/command_line/option_table.hpp"
#include "app/input/standard_input.hpp"
#include "app/requests/source_words.hpp"
#include "session/capture.hpp"
#include "session/clip_source.hpp"
#include "session/error.hpp"
#include "session/format.hpp"
#include "session/pictures.hpp"

namespace nutik::app {
namespace {

// Files have a place of their own in a recipe, with their text or checksum.
bool is_stated(const Option& option, std::string_view value) {
  return option.is_of(CommandId::expose) && option.makes_picture() &&
         (!option.reads_file() || option.knows(value));
}

std::map<std::string, std::string> stated_options(const Options& options) {
  std::map<std::string, std::string> stated;
  for (const Option& option : app::options()) {
    const std::string* value = option.stated(options);
    if (value != nullptr && is_stated(option, *value)) stated.emplace(option.long_name, *value);
  }
  return stated;
}

// What came from standard input gets a name that a file can have.
std::string known_name(const std::string& name, const char* extension) {
  return is_standard_input(name) ? std::string("standard-input") + extension : input_name(name);
}

Recipe::Text whole_text(const std::string& name, const char* extension) {
  return {known_name(name, extension), std::string(InputBytes(name).text())};
}

Recipe make_recipe(const Options& options, const std::optional<std::string>& known_capture) {
  Recipe recipe;
  recipe.version = NUTIK_VERSION;
  const std::string& input = options.operands.front();
  recipe.capture = {input_name(input), known_capture ? *known_capture : capture_checksum(input)};
  if (options.functions) recipe.functions = whole_text(*options.functions, ".fn");
  if (options.noise && *options.noise != kAutomaticNoise) recipe.noise = whole_text(*options.noise, ".noise");
  if (options.mask) {
    recipe.mask =
        Recipe::Input{known_name(*options.mask, ".pgm"),
                      is_standard_input(*options.mask) ? bytes_checksum(InputBytes(*options.mask).bytes())
                                                       : input_checksum(*options.mask)};
  }
  recipe.options = stated_options(options);
  recipe.renderer = options.renderer.value_or("opencl");
  return recipe;
}

}  // namespace

bool is_recipe_option(std::string_view long_name, std::string_view value) {
  return std::ranges::any_of(app::options(), [&](const Option& option) {
    return option.long_name == long_name && is_stated(option, value);
  });
}

std::string capture_checksum(const std::string& path) {
  if (!is_tik(path)) return input_checksum(path);
  return format("xxh3-64-tik:{:016x}", tik::Reader(path).content_checksum());
}

PictureRecipe::PictureRecipe(const Options& options, std::optional<std::string> known_capture)
    : options_(options) {
  if (!options.no_recipe) {
    reading_ = std::async(std::launch::async,
                          [this, known = std::move(known_capture)] { return make_recipe(options_, known); });
  }
}

std::string PictureRecipe::text(const std::string& precision, const OwnRecipe& own) {
  if (options_.no_recipe) return {};
  if (!recipe_) recipe_ = reading_.get();
  Recipe recipe = *recipe_;
  recipe.precision = precision;
  if (own.functions) recipe.functions = own.functions;
  for (const auto& [name, value] : own.options) {
    recipe.options.erase(name);
    if (value) recipe.options.emplace(name, *value);
  }
  std::string text = recipe.text();
  if (text.size() >= kMostPictureTextBytes) {
    throw InputError(
        format("the recipe has {} bytes and a picture carries {} MiB at most; leave it out: --no-recipe",
               text.size(), kMostPictureTextBytes >> 20));
  }
  return text;
}

}  // namespace nutik::app
