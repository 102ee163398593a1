#include "studio/window/command_line.hpp"

#include <filesystem>
#include <utility>
#include <vector>

#include "session/below/format.hpp"
#include "session/requests/function_input.hpp"
#include "session/text/shell_text.hpp"
#include "studio/document/texts.hpp"
#include "system/input_bytes.hpp"

namespace nutik::studio {
namespace {

using NamedOptions = std::vector<std::pair<std::string, std::string>>;

// All but the files, by name.
NamedOptions options_of(const Document& document) {
  const DocumentState& state = document.state();
  const bool is_plain = state.mode == ExposureMode::boxcar;
  NamedOptions options;
  if (state.brightness_ev != 0) options.emplace_back("ev", format("{}", state.brightness_ev));
  if (is_plain) options.emplace_back("exposure", StatedTime::of_nanoseconds(state.boxcar.length_ns).text());
  if (const Feather feather = feather_of(state); !is_plain && state.mask && feather != Feather())
    options.emplace_back("feather", feather_text(feather));
  if (!document.facts()->rate.isEmpty()) options.emplace_back("fps", document.facts()->rate.toStdString());
  if (state.normalization != Normalization()) options.emplace_back("normalize", state.normalization.text());
  if (is_plain) options.emplace_back("start", StatedTime::of_nanoseconds(state.boxcar.start_ns).text());
  return options;
}

std::string file_name(const QString& path) {
  return std::filesystem::path(path.toStdString()).filename().string();
}

}  // namespace

QString command_line(const Document& document, const CommandFiles& files, const QString& picture) {
  const DocumentState& state = document.state();
  std::string line = "nutik-cl expose";
  const auto add = [&](const std::string& option, const QString& file) {
    line += " " + option + " " + shell_word(file.toStdString());
  };
  if (state.mode == ExposureMode::functions) {
    add("-k", files.functions);
    if (state.mask) add("-m", files.mask);
  }
  for (const auto& [name, value] : options_of(document)) line += " --" + name + " " + shell_word(value);
  line += " " + shell_word(document.facts()->path.toStdString()) + " " + shell_word(picture.toStdString());
  return QString::fromStdString(line);
}

RecipeSources recipe_sources(const Document& document, const CommandFiles& files) {
  const DocumentState& state = document.state();
  RecipeSources sources{{}, document.facts()->path.toStdString(), {}};
  Recipe& recipe = sources.made;
  recipe.version = NUTIK_VERSION;
  recipe.options = options_of(document);
  recipe.renderer = "opencl";
  if (state.mode == ExposureMode::functions) {
    recipe.functions = Recipe::Text{file_name(files.functions),
                                    std::string(InputBytes(files.functions.toStdString()).text())};
    if (state.mask)
      recipe.mask = Recipe::Input{file_name(files.mask), mask_checksum(files.mask.toStdString())};
  }
  return sources;
}

}  // namespace nutik::studio
