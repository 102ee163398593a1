#include "app/output/output_name.hpp"

#include "app/command_line/option_table.hpp"
#include "app/input/standard_input.hpp"
#include "session/error.hpp"
#include "session/format.hpp"
#include "session/pictures.hpp"

namespace nutik::app {

std::optional<std::filesystem::path> stated_output(const std::optional<std::string>& option,
                                                   std::span<const std::string> operands,
                                                   const std::string& command) {
  if (operands.empty()) throw UsageError(format("an input is missing; see nutik-cl {} --help", command));
  if (operands.size() > 2) {
    throw UsageError(
        format("'{}' is one file too many; a sequence of stills is one operand: its folder, or a "
               "pattern in quotes such as 'frames/*.png'. See nutik-cl {} --help",
               operands[2], command));
  }
  if (option && operands.size() == 2) {
    throw UsageError(format("two outputs: -o {} and {}; leave one out", *option, operands[1]));
  }
  for (const auto* name : {option ? &*option : nullptr, operands.size() == 2 ? &operands[1] : nullptr}) {
    if (name == nullptr) continue;
    if (name->empty()) throw UsageError("the output's name is empty");
    return *name;
  }
  return std::nullopt;
}

std::filesystem::path picture_name(const std::string& input, const std::string& label) {
  return sequence_name(input) + "-" + label + ".png";
}

std::vector<std::string> input_files(const Options& options) {
  std::vector<std::string> inputs(options.operands.begin(),
                                  options.operands.begin() + !options.operands.empty());
  if (!inputs.empty() && !options.raw) {
    // Each still of a sequence is an input that the picture must not replace.
    for (const auto& still : list_stills(inputs.front()).value_or(std::vector<std::filesystem::path>{})) {
      inputs.push_back(still.string());
    }
  }
  for (const Option& option : app::options()) {
    const std::string* name = option.reads_file() ? option.stated(options) : nullptr;
    if (name != nullptr && !is_standard_input(*name) && !option.knows(*name)) inputs.push_back(*name);
  }
  return inputs;
}

}  // namespace nutik::app
