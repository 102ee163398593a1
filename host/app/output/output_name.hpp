// Where a command writes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "features/schema/options.hpp"
#include "media/formats/numbered_name.hpp"
#include "media/writers/recipe.hpp"
#include "session/exposed_picture.hpp"
#include "session/output_check.hpp"

namespace nutik::app {

// The output that was asked for: -o or the second operand. Throws UsageError where both were given, or there are no
// operands, or more than `command` takes.
[[nodiscard]] std::optional<std::filesystem::path> stated_output(const Options& options,
                                                                 std::string_view command);
// The same, else a name made from the input's: `clip-motion.png` with `-motion.png` behind it.
[[nodiscard]] std::filesystem::path output_name(const Options& options, std::string_view command,
                                                std::string_view behind);

// What the outputs may take the place of.
[[nodiscard]] inline Replacing replacing(const Options& options) {
  return options.overwrite ? Replacing::all : Replacing::made_by_recipe;
}

// Whether standard output takes a picture, so that nothing else may go there. Throws UsageError where something must.
[[nodiscard]] bool writes_to_standard_output(const Options& options);

// Names of many pictures, of a pattern like `motion-%03d.png`; numbers count from 0, as pictures of a clip do.
class PictureNames {
 public:
  // Throws UsageError where the pattern has no place for a number; `who` needs one in the name of these `things`.
  PictureNames(const std::filesystem::path& pattern, std::string_view who, std::string_view things = "pictures");

  [[nodiscard]] std::filesystem::path operator[](std::uint64_t k) const { return folder_ / name_.with(k); }

 private:
  std::filesystem::path folder_;
  NumberedName name_;
};

// Where --bounds puts the map of each picture: a file, or with `has_many` one with the picture's number.
class BoundsMaps {
 public:
  // `who` asks, in messages. Throws UsageError where the name is that of no file of floats, lacks a number, or has one
  // for a single picture.
  BoundsMaps(const Options& options, bool has_many, std::string_view who);

  [[nodiscard]] bool are_asked() const { return stated_.has_value(); }
  // Empty where none is asked for.
  [[nodiscard]] std::filesystem::path of(std::uint64_t number) const {
    return names_ ? (*names_)[number] : stated_.value_or(std::filesystem::path());
  }
  // Throws UsageError where it is an input or the picture itself, or may not be replaced, as the map that the picture's
  // recipe knows beside it may; where the picture's kind loses more than is counted.
  void check(std::uint64_t number, std::vector<std::string> inputs, const std::filesystem::path& picture,
             Replacing replacing) const;
  // Where it is asked for; returns what the picture's recipe is to know it by. Throws OutputError.
  std::optional<Recipe::Input> write(std::uint64_t number, const ExposedPicture& exposed) const;

 private:
  std::optional<std::filesystem::path> stated_;
  std::optional<PictureNames> names_;
  bool is_half_ = false;  // pictures of which lose more
};

// The files that a command reads, each still of a sequence among them: no output may replace one. Its first operand is
// one of them, where it has any.
[[nodiscard]] std::vector<std::string> input_files(const Options& options);

// For --skip-existing: throws UsageError where a picture of that name would carry no recipe to be known by.
void require_recipes(const Options& options, const std::filesystem::path& picture);

// The arithmetic that was asked for; none for `auto`.
[[nodiscard]] std::optional<std::string> stated_precision(const Options& options);

// That all of so many `things` are there. Returns the exit status.
int tell_all_made(const Options& options, const std::filesystem::path& output, std::size_t count,
                  std::string_view thing);

}  // namespace nutik::app
