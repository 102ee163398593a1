// The recipe of what `expose` makes, as the picture keeps it.
#pragma once

#include <future>
#include <optional>
#include <string>

#include "app/command_line/options.hpp"
#include "media/recipe.hpp"

namespace nutik::app {

class PictureRecipe {
 public:
  // Reads the checksums of capture and mask beside whatever the caller does next; `options` must outlive
  // this. With --no-recipe it does nothing.
  explicit PictureRecipe(const Options& options);

  // The recipe's text, for a picture that was computed in this precision; empty with --no-recipe. Of a series, each
  // picture's is that of a single one from its own `start` on. Throws InputError where an input cannot
  // be read.
  [[nodiscard]] std::string text(const std::string& precision, const std::optional<std::string>& start = {});

 private:
  const Options& options_;
  std::future<Recipe> reading_;
  std::optional<Recipe> recipe_;  // once it was read
};

// What the content of a capture is known by again: of a .tik its blocks' and footer's checksums.
[[nodiscard]] std::string capture_checksum(const std::string& path);

}  // namespace nutik::app
