// Whether a file may be written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/error.hpp"
#include "media/writers/recipe.hpp"
#include "system/output_file.hpp"

namespace nutik {

enum class OutputKind { tik, picture, mask, table, video, noise, functions };

// What an output may take the place of: nothing but an empty file and a picture that is as it was written with its
// recipe, and so can be made again, or all of its kind.
enum class Replacing { made_by_recipe, all };

// Throws UsageError where `output` names one of the inputs, has a name of another kind, would replace a file of
// another kind (a mask replaces no exposure, which carries a recipe, nor a picture in colour) or one that it
// may not, or is standard output and that a terminal. Unless it may replace all of its kind, what is there once it has
// been made has to be what is there now (system/output_file.hpp). Throws OutputError where its folder takes no file.
void check_output(const std::filesystem::path& output, OutputKind kind, std::span<const std::string> inputs,
                  Replacing replacing = Replacing::all);
// The same of a mask, whose file keeps every tag.
void check_mask_output(const std::filesystem::path& output, std::span<const std::string> inputs,
                       Replacing replacing = Replacing::all);
[[nodiscard]] bool is_mask_name(const std::filesystem::path& path);
// check_output() for a picture of 8-bit codes; throws, too, where its file cannot hold so many channels.
void check_picture_output(const std::filesystem::path& output, std::uint32_t channels,
                          std::span<const std::string> inputs, Replacing replacing = Replacing::all);

// The recipe that any file carries: none where there is no file, no picture, or a damaged one.
[[nodiscard]] std::optional<Recipe> recipe_in(const std::filesystem::path& file);

// Notes the pictures that are there under the numbers from `count` on: a series of so many does not replace them.
void note_later(std::vector<std::string>& notes, const std::function<std::filesystem::path(std::uint64_t)>& picture,
                std::uint64_t count);

}  // namespace nutik
