#include "app/input/input_files.hpp"

#include <filesystem>

#include "media/still_sequence.hpp"

namespace nutik::app {

std::vector<std::string> input_files(const Options& options) {
  std::vector<std::string> inputs{options.operands.front()};
  if (!options.raw) {
    // Each still of a sequence is an input that the picture must not replace.
    for (const auto& still : list_stills(inputs.front()).value_or(std::vector<std::filesystem::path>{})) {
      inputs.push_back(still.string());
    }
  }
  if (options.mask) inputs.push_back(*options.mask);
  if (options.functions) inputs.push_back(*options.functions);
  return inputs;
}

}  // namespace nutik::app
