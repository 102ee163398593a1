#include "app/output/picture_recipe.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "app/command_line/option_table.hpp"
#include "app/input/capture_input.hpp"
#include "app/input/standard_input.hpp"
#include "capture/format.hpp"
#include "media/input_checksum.hpp"
#include "tik/reader.hpp"

namespace nutik::app {
namespace {

// Options of `expose` that do not make the picture, or that the recipe has in another place.
constexpr std::array<std::string_view, 9> kLeftOut{"output", "mask",     "functions", "every", "count",
                                                   "device", "renderer", "precision", "memory"};

std::map<std::string, std::string> stated_options(const Options& options) {
  std::map<std::string, std::string> stated;
  for (const Option& option : app::options()) {
    if ((option.commands & bit(CommandId::expose)) == 0 || option.member == nullptr) continue;
    if (std::ranges::find(kLeftOut, option.long_name) != kLeftOut.end()) continue;
    if (const auto& value = options.*option.member) stated.emplace(option.long_name, *value);
  }
  return stated;
}

// What came from standard input gets a name that a file can have.
std::string known_name(const std::string& name, const char* extension) {
  return is_standard_input(name) ? std::string("standard-input") + extension : input_name(name);
}

Recipe make_recipe(const Options& options, const std::optional<std::string>& known_capture) {
  Recipe recipe;
  recipe.version = NUTIK_VERSION;
  const std::string& input = options.operands.front();
  recipe.capture = {input_name(input), known_capture ? *known_capture : capture_checksum(input)};
  if (options.functions) {
    recipe.functions = Recipe::Text{known_name(*options.functions, ".fn"),
                                    std::string(InputBytes(*options.functions).text())};
  }
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

std::string PictureRecipe::text(const std::string& precision, const std::optional<std::string>& start) {
  if (options_.no_recipe) return {};
  if (!recipe_) recipe_ = reading_.get();
  recipe_->precision = precision;
  if (start) recipe_->options["start"] = *start;
  return recipe_->text();
}

}  // namespace nutik::app
