#include <algorithm>
#include <array>
#include <filesystem>
#include <span>

#include "app/output/console.hpp"
#include "app/run.hpp"
#include "app/words/stated_requests.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/noise_file.hpp"
#include "capture/source_text.hpp"
#include "capture/text.hpp"
#include "features/schema/option.hpp"
#include "features/schema/options.hpp"
#include "media/input_checksum.hpp"
#include "media/stills/still_sequence.hpp"
#include "media/writers/recipe.hpp"
#include "session/requests/delay_request.hpp"
#include "session/requests/named_inputs.hpp"
#include "session/text/shell_text.hpp"
#include "system/mapped_file.hpp"
#include "system/output_file.hpp"

namespace nutik::app {
namespace {

namespace fs = std::filesystem;

// Looks for a recipe's inputs, by name and content.
class RecipeFiles {
 public:
  explicit RecipeFiles(std::vector<fs::path> folders) : folders_(std::move(folders)) {}

  // The first file of that name with that checksum. Otherwise warns and returns the first of that name, or the name
  // alone; the picture cannot be made again then.
  template <typename Checksum>
  fs::path find(const Recipe::Input& input, std::string_view what, Checksum checksum) {
    std::optional<fs::path> other_folder;
    const std::string name = shown(input.name);
    for (const fs::path& folder : folders_) {
      const fs::path path = folder / input.name;
      try {
        if (!is_there(path)) continue;
        if (checksum(path.string()) == input.checksum) return path;
      } catch (const InputError& error) {
        print_warning(message_text(error, Dialect::command_line));
        continue;
      }
      if (!other_folder) other_folder = folder;
    }
    is_complete_ = false;
    print_warning(
        other_folder ? format("{} is not the {} that the picture was made from: its checksum differs from {}",
                              (*other_folder / name).string(), what, shown(input.checksum))
                     : format("the {} {} is not in {}; name its folder: nutik-cl reproduce PICTURE FOLDER", what,
                              name, folders_text()));
    return other_folder.value_or(fs::path()) / input.name;
  }

  // A file of that name with that text; otherwise it is written into `folder` under a name with that extension, and a
  // warning says so. `what` is in the plural.
  fs::path find(const Recipe::Text& text, std::string_view what, const fs::path& folder,
                const char* extension) const {
    bool is_changed = false;
    std::error_code unknown;
    for (const fs::path& place : folders_) {
      const fs::path path = place / text.name;
      if (!fs::is_regular_file(path, unknown)) continue;
      if (holds(path, text)) return path;
      is_changed = true;
    }
    const std::string name = text.name + (text.name.ends_with(extension) ? "" : extension);
    write(text, what, folder, name, is_changed);
    return folder / name;
  }

  [[nodiscard]] bool is_complete() const { return is_complete_; }

 private:
  static void write(const Recipe::Text& text, std::string_view what, const fs::path& folder,
                    const std::string& name, bool is_changed) {
    std::error_code unknown;
    if (!fs::is_symlink(folder, unknown) && !fs::is_symlink(folder / name, unknown) && holds(folder / name, text))
      return;
    write_new_text(folder, name, text.bytes);
    print_warning(format("{} {}; the {} that the picture was made with were written to {}", shown(text.name),
                         is_changed ? "was changed since" : "is not there", what,
                         (folder / shown(name)).string()));
  }

  static bool is_there(const fs::path& path) {
    std::error_code unknown;
    if (fs::exists(path, unknown) || !layer_files(path.string()).empty()) return true;
    try {
      return list_stills(path).has_value();  // a pattern
    } catch (const InputError&) {
      return false;
    }
  }

  static bool holds(const fs::path& path, const Recipe::Text& text) {
    std::error_code unknown;
    if (!fs::is_regular_file(path, unknown)) return false;
    const MappedFile file(path);
    return std::ranges::equal(file.bytes(), std::as_bytes(std::span(text.bytes)));
  }

  [[nodiscard]] std::string folders_text() const {
    return joined(folders_, ", ", [](const fs::path& folder) {
      return folder.empty() ? "the current folder" : folder.string();
    });
  }

  std::vector<fs::path> folders_;  // empty: the current one
  bool is_complete_ = true;
};

std::vector<fs::path> folders_to_search(const Options& options) {
  std::vector<fs::path> folders;
  for (std::size_t i = 1; i < options.operands.size(); ++i) {
    if (!fs::is_directory(options.operands[i])) {
      throw UsageError(
          format("{} is no folder; reproduce looks in folders for the files that the picture was made from",
                 options.operands[i]));
    }
    folders.emplace_back(options.operands[i]);
  }
  folders.emplace_back();
  const fs::path beside = fs::path(options.operands.front()).parent_path();
  if (!beside.empty()) folders.push_back(beside);
  return folders;
}

// A picture of delays has a place of its own, with its checksum; beside it stands its range.
bool is_delay(const Recipe& recipe, const std::string& value) {
  try {
    return DelayRequest::parse((recipe.delay_map ? "rows:" : "") + value, "delay").file.empty();
  } catch (const UsageError&) {
    return false;
  }
}

// What is printed may be run by a shell: of a stranger's picture it names options that recipes have, and no others.
void check_options(const Recipe& recipe, const std::string& picture) {
  for (const auto& [name, value] : recipe.options) {
    if (is_recipe_option(name, value, recipe.of) && (name != "delay" || is_delay(recipe, value))) continue;
    throw InputError(
        format("{}: its recipe states {}, which no recipe of nutik-cl {} does; another version made "
               "it, or it is not to be trusted",
               picture, nutik::quoted("--" + name + " " + value), NUTIK_VERSION));
  }
}

// Options that earlier versions took, though they changed nothing, and that commands refuse now.
bool has_no_effect(const Recipe& recipe, std::string_view name) {
  const auto states = [&](std::string_view wanted) {
    return std::ranges::any_of(recipe.options, [&](const auto& option) { return option.first == wanted; });
  };
  return (name == "unmapped" && !recipe.mask) || (name == "shutter-error" && !states("shutter")) ||
         (name == "mask-blend" && !recipe.mask_to && !states("mask-key"));
}

// An earlier recipe, which tells nothing of its file, may have that of a video without what lies beside it.
std::string checksum_of_capture(const std::string& capture, const Recipe& recipe) {
  std::string checksum = capture_checksum(capture, recipe);
  if (checksum == recipe.capture.checksum || !recipe.file.empty() || !fs::is_regular_file(capture)) return checksum;
  std::string alone = files_checksum(std::array{fs::path(capture)});
  return alone == recipe.capture.checksum ? alone : checksum;
}

std::string text_title(const Recipe::Text& text, const fs::path& picture) {
  return format("{} in the recipe of {}", shown(text.name), picture.string());
}

std::string operand(const fs::path& path) { return shell_word(not_an_option(path.string())); }

}  // namespace

int run_reproduce(const Options& options) {
  if (options.operands.empty()) throw UsageError("reproduce takes a picture: nutik-cl reproduce picture.png");
  const fs::path picture = options.operands.front();
  RecipeFiles files(folders_to_search(options));
  const std::optional<Recipe> recipe = read_recipe(picture);
  if (!recipe) {
    throw InputError(format(
        "{} carries no recipe. Exposures, sheets and a video's stills do, but not backgrounds, charts, traces, masks, "
        "maps of bounds and .pfm files; --no-recipe leaves it out, and programs that write a picture anew lose it",
        picture.string()));
  }
  if (recipe->version != NUTIK_VERSION) {
    print_note(format("note: the picture was made by nutik-cl {}, this is {}", shown(recipe->version),
                      NUTIK_VERSION));
  } else if (recipe->file.empty()) {
    print_note("note: an earlier nutik-cl made the picture; where the clip is aligned, deflickered, scaled, rounded "
               "(--tolerance) or filled (--between), this one may make other codes of it");
  }
  check_options(*recipe, picture.string());
  const fs::path folder = picture.stem().string() + "-again";
  std::string command = format("{} {}", shell_word(options.program), to_text(recipe->of));
  if (recipe->functions) {
    static_cast<void>(read_functions(recipe->functions->bytes, text_title(*recipe->functions, picture)));
    command += " -k " + operand(files.find(*recipe->functions, "functions", folder, ".fn"));
  }
  if (recipe->noise) {
    static_cast<void>(parse_noise(recipe->noise->bytes, text_title(*recipe->noise, picture)));
    const fs::path here = ".";  // so that a file of the name `auto` is not taken for that word
    command += " --noise " + operand(here / files.find(*recipe->noise, "noise values", folder, ".noise"));
  }
  if (recipe->mask) command += " -m " + operand(files.find(*recipe->mask, "mask", mask_checksum));
  if (recipe->mask_to)
    command += " --mask-to " + operand(files.find(*recipe->mask_to, "second mask", mask_checksum));
  for (const auto& [name, value] : recipe->options) {
    if (has_no_effect(*recipe, name)) continue;
    command += " " + shell_word("--" + name);
    if (name == "delay" && recipe->delay_map) {
      const auto of_map = [](const std::string& file) { return input_checksum(file); };
      const fs::path map = files.find(*recipe->delay_map, "map of delays", of_map);
      command += " " + operand(map.string() + ":" + value);
    } else if (!value.empty()) {
      command += " " + shell_word(value);
    }
  }
  command += recipe->renderer == "opencl" ? " --precision " + shell_word(recipe->precision)
                                          : " --renderer " + shell_word(recipe->renderer);
  if (recipe->bounds_map) command += " --bounds " + operand(picture.parent_path() / recipe->bounds_map->name);
  const auto checksum = [&](const std::string& capture) { return checksum_of_capture(capture, *recipe); };
  command += " " + operand(files.find(recipe->capture, "capture", checksum));
  command += " -o " + operand(picture);
  print_line(command);
  return files.is_complete() ? ExitStatus::ok : ExitStatus::input;
}

}  // namespace nutik::app
