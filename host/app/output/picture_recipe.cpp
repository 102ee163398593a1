#include "app/output/picture_recipe.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "app/command_line/option_table.hpp"
#include "app/input/capture_input.hpp"
#include "capture/format.hpp"
#include "media/input_checksum.hpp"
#include "system/mapped_file.hpp"
#include "tik/reader.hpp"

namespace nutik::app {
namespace {

// Options of `expose` that do not make the picture, or that the recipe has in another place.
constexpr std::array<std::string_view, 8> kLeftOut{"output", "mask",   "functions", "every",
                                                   "count",  "device", "renderer",  "precision"};

std::map<std::string, std::string> stated_options(const Options& options) {
  std::map<std::string, std::string> stated;
  for (const Option& option : app::options()) {
    if ((option.commands & bit(CommandId::expose)) == 0 || option.member == nullptr) continue;
    if (std::ranges::find(kLeftOut, option.long_name) != kLeftOut.end()) continue;
    if (const auto& value = options.*option.member) stated.emplace(option.long_name, *value);
  }
  return stated;
}

Recipe make_recipe(const Options& options) {
  Recipe recipe;
  recipe.version = NUTIK_VERSION;
  const std::string& input = options.operands.front();
  recipe.capture = {input_name(input), capture_checksum(input)};
  if (options.functions) {
    const MappedFile file(*options.functions);
    const auto bytes = file.bytes();
    recipe.functions = Recipe::Text{input_name(*options.functions),
                                    {reinterpret_cast<const char*>(bytes.data()), bytes.size()}};
  }
  if (options.mask) recipe.mask = Recipe::Input{input_name(*options.mask), input_checksum(*options.mask)};
  recipe.options = stated_options(options);
  recipe.renderer = options.renderer.value_or("opencl");
  return recipe;
}

}  // namespace

std::string capture_checksum(const std::string& path) {
  if (!is_tik(path)) return input_checksum(path);
  return format("xxh3-64-tik:{:016x}", tik::Reader(path).content_checksum());
}

PictureRecipe::PictureRecipe(const Options& options) : options_(options) {
  if (!options.no_recipe) {
    reading_ = std::async(std::launch::async, [this] { return make_recipe(options_); });
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
