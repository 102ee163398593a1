// Recipes: how a picture was made, kept in the picture (docs/reference/recipes.md).
//
//   in:      what an exposure was made from and with
//   out:     one line of printable ASCII: a JSON object that starts with {"nutik-cl":
//   always:  the same recipe is the same text, byte for byte: no dates, no folders. A picture may come from
//            anyone, so names that are read lead no way out of a folder: see parse()
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "media/stills/picture_text.hpp"

namespace nutik {

// What a recipe makes, by the name of the command.
enum class RecipeOf { expose, contact, sweep };
[[nodiscard]] std::string_view to_text(RecipeOf of);

struct Recipe {
  // A file by its name, without its folder, and what its content is known by.
  struct Input {
    std::string name;
    std::string checksum;

    friend bool operator==(const Input&, const Input&) = default;
  };
  // A file that is short enough to be kept whole.
  struct Text {
    std::string name;
    std::string bytes;
  };

  std::string version;  // of the program
  // What the picture's file is known by: seal_picture() puts it in (stills/picture_text.hpp). Empty in pictures of
  // earlier programs.
  std::string file = std::string(kUnsealed);
  RecipeOf of = RecipeOf::expose;
  Input capture;
  std::optional<Text> functions;
  std::optional<Text> noise;
  std::optional<Input> delay_map;  // a picture of delays, whose range is the value of the option `delay`
  std::optional<Input> mask, mask_to;
  // What arithmetic may be off by in each pixel, beside the picture; earlier programs stated no checksum.
  std::optional<Input> bounds_map;
  // Long names without dashes, and values. Of an exposure by name; of a sheet as they were stated, which says what its
  // rows and columns are.
  std::vector<std::pair<std::string, std::string>> options;
  std::string renderer;
  std::string precision;
  std::string error_bound;  // the same for people, of all pixels; empty: none

  [[nodiscard]] std::string text() const;

  // Reads a text that text() wrote. Throws InputError naming `name` where it is none, makes what no recipe does, or the
  // name of functions
  // or noise or of a map is not that of a file alone, or that of capture or mask has more than one plain folder.
  static Recipe parse(std::string_view text, const std::string& name);
};

// The recipe that a picture carries; nothing where it is a picture without one. Throws InputError where the
// file cannot be read or is no picture that could carry one, or its recipe is damaged.
[[nodiscard]] std::optional<Recipe> read_recipe(const std::filesystem::path& picture);

}  // namespace nutik
