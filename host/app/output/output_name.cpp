#include "app/output/output_name.hpp"

#include <algorithm>

#include "app/output/report.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/schema/option.hpp"
#include "media/formats/numbered_name.hpp"
#include "media/input_checksum.hpp"
#include "media/stills/still_sequence.hpp"
#include "media/writers/picture_writer.hpp"
#include "session/output_check.hpp"
#include "session/requests/delay_request.hpp"
#include "session/requests/named_inputs.hpp"
#include "session/text/number_text.hpp"
#include "session/text/shell_text.hpp"
#include "system/input_bytes.hpp"
#include "system/is_absent.hpp"

namespace nutik::app {

namespace {

// A picture's or a capture's name, and no pattern.
bool names_an_output(const std::string& name) {
  const bool is_pattern = name.find_first_of("*?[%") != name.npos;
  return !is_pattern && (is_picture_name(name) || std::filesystem::path(name).extension() == ".tik");
}

}  // namespace

std::optional<std::filesystem::path> stated_output(const Options& options, std::string_view command) {
  const Options::Text& option = options.output;
  const std::vector<std::string>& operands = options.operands;
  if (operands.empty()) throw UsageError(format("an input is missing; see nutik-cl {} --help", command));
  if (operands.size() > 2) {
    throw UsageError(
        format("'{}' is one file too many; a sequence of stills is one operand: its folder, or a "
               "pattern in quotes such as 'frames/*.png'. See nutik-cl {} --help",
               operands[2], command));
  }
  const bool are_swapped = operands.size() == 2 && names_an_output(operands[0]) &&
                           !is_standard_input(operands[0]) && is_absent(operands[0]) &&
                           !names_an_output(operands[1]) && !is_absent(operands[1]);
  if (are_swapped) {
    throw UsageError(format("there is no file {}, and {} is one; the input comes first: nutik-cl {} {} {}", operands[0],
                            operands[1], command, shell_word(operands[1]), shell_word(operands[0])));
  }
  if (option && operands.size() == 2) {
    throw UsageError(format("two outputs: -o {} and {}; leave one out", *option, operands[1]));
  }
  if (!option && operands.size() == 1) return std::nullopt;
  const std::string& name = option ? *option : operands[1];
  if (name.empty()) throw UsageError("the output's name is empty");
  return name;
}

std::filesystem::path output_name(const Options& options, std::string_view command, std::string_view behind) {
  if (const auto stated = stated_output(options, command)) return *stated;
  std::string name = sequence_name(options.operands.front());
  std::ranges::replace(name, '%', '_');  // nobody asked for numbers
  name += behind;
  const auto recipe = options.overwrite ? std::nullopt : recipe_in(name);
  if (recipe && recipe->capture.name != input_name(options.operands.front())) {
    throw UsageError(format("{} is there already, made of {}, and is not replaced; choose another name, or replace it "
                            "with --overwrite",
                            name, recipe->capture.name));
  }
  return name;
}

bool writes_to_standard_output(const Options& options) {
  const bool is_second = !options.output && options.operands.size() == 2;
  const bool writes = (options.output && names_standard_output(*options.output)) ||
                      (is_second && names_standard_output(options.operands[1]));
  if (writes && options.json)
    throw UsageError("--json answers on standard output, where the picture goes; use one");
  return writes;
}

static Recipe::Input known_map(const std::filesystem::path& map) {
  return {map.filename().string(), files_checksum({&map, 1})};
}

// Whether the picture's recipe knows this very file: a name alone may be that of another file.
static bool is_map_of(const std::filesystem::path& picture, const std::filesystem::path& map) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(map, unknown) || led_to(map) != led_to(picture.parent_path() / map.filename()))
    return false;
  const auto recipe = recipe_in(picture);
  return recipe && recipe->bounds_map == known_map(map);
}

BoundsMaps::BoundsMaps(const Options& options, bool has_many, std::string_view who) {
  if (!options.picture.bounds) return;
  stated_ = *options.picture.bounds;
  is_half_ = options.picture.depth == Depth::half;
  if (names_standard_output(*stated_)) throw UsageError("--bounds writes a file: standard output has one picture");
  static_cast<void>(value_type_for(*stated_, Depth::floating, ValueType::light32, 1));
  if (has_many) names_.emplace(*stated_, who, "maps");
  if (!has_many && NumberedName::parse(stated_->filename().string()))
    throw UsageError(format("{} numbers maps, and {} has one: name it without %", stated_->string(), who));
}

void BoundsMaps::check(std::uint64_t number, std::vector<std::string> inputs, const std::filesystem::path& picture,
                       Replacing replacing) const {
  if (!stated_) return;
  if (is_half_ || is_lossy_name(picture)) {
    throw UsageError(format("--bounds: {} loses more than a map counts; write a .png, a .tif, or floats of 32 bits",
                            is_half_ ? "--depth half" : picture.string()));
  }
  inputs.push_back(picture.string());
  if (replacing != Replacing::all) {
    expect_as_it_is(of(number));
    if (is_map_of(picture, of(number))) replacing = Replacing::all;
  }
  check_output(of(number), OutputKind::picture, inputs, replacing);
}

std::optional<Recipe::Input> BoundsMaps::write(std::uint64_t number, const ExposedPicture& exposed) const {
  if (exposed.bounds.empty()) return std::nullopt;
  write_layers(of(number), exposed.bounds);
  return known_map(of(number));
}

PictureNames::PictureNames(const std::filesystem::path& pattern, std::string_view who, std::string_view things)
    : folder_(pattern.parent_path()) {
  const auto name = NumberedName::parse(pattern.filename().string());
  if (!name) {
    throw UsageError(
        format("{} needs a number in its {}' name, as in {}; {} would be written again and again", who, things,
               (folder_ / (pattern.stem().string() + "-%03d" + pattern.extension().string())).string(),
               pattern.string()));
  }
  name->expect_one(pattern.string());
  name_ = *name;
}

std::vector<std::string> input_files(const Options& options) {
  std::vector<std::string> inputs(options.operands.begin(),
                                  options.operands.begin() + !options.operands.empty());
  if (!inputs.empty() && !options.source.clip.raw) {
    // Each still of a sequence is an input that the picture must not replace.
    for (const auto& still : list_stills(inputs.front()).value_or(std::vector<std::filesystem::path>{})) {
      inputs.push_back(still.string());
    }
  }
  const auto add = [&](const std::string& name) {
    inputs.push_back(name);
    for (const auto& [tag, layer] : layer_files(name)) inputs.push_back(layer.string());
  };
  for (const Option& option : schema()) {
    const std::string* name = option.reads_file() ? option.stated(options) : nullptr;
    if (name != nullptr && !is_standard_input(*name) && !option.knows(*name)) add(*name);
  }
  for (const Said& said : options.said) {  // key frames, which may be given again and again
    if (said.row->take == nullptr && said.row->reads_standard_input() && said.words.size() > 1) add(said.words.back());
  }
  if (options.asked.delay && !options.asked.delay->file.empty()) inputs.push_back(options.asked.delay->file);
  return inputs;
}

void require_recipes(const Options& options, const std::filesystem::path& picture) {
  if (options.no_recipe) {
    throw UsageError("--skip-existing knows pictures by their recipes, and --no-recipe makes them without; use one");
  }
  if (names_standard_output(picture) || !has_text_by_name(picture)) {
    throw UsageError(
        format("--skip-existing knows pictures by their recipes, and {} has no place for one; write pictures, for a "
               "video numbered ones: frame-%05d.png, .tif, .exr, …",
               picture.string()));
  }
}

std::optional<std::string> stated_precision(const Options& options) {
  return options.precision ? std::optional(to_text(*options.precision)) : std::nullopt;
}

int tell_all_made(const Options& options, const std::filesystem::path& output, std::size_t count,
                  std::string_view thing) {
  Answer answer{{{"picture", output.string()}, {"skipped", count}}};
  answer.line = format("{}: {}, there already", output.string(), counted(count, std::string(thing)));
  return tell(options, output, answer);
}

}  // namespace nutik::app
