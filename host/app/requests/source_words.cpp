#include "app/requests/source_words.hpp"

#include <CLI/CLI.hpp>
#include <charconv>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik::app {
namespace {

std::uint64_t parse_size(const std::string& stated) {
  std::string text = stated;
  std::uint64_t bytes = 0;
  try {
    const std::string mistake = CLI::AsSizeValue(true)(text);  // replaces the text by its number of bytes
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), bytes);
    if (mistake.empty() && error == std::errc() && end == text.data() + text.size() && bytes > 0)
      return bytes;
  } catch (const CLI::Error&) {
    // Its message lists units only.
  }
  throw UsageError(format("--memory '{}' is no size; write 500MB, 2GB or 1GiB", stated));
}

}  // namespace

MemoryBudget memory_budget(const Options& options) {
  return options.memory ? MemoryBudget{parse_size(*options.memory)} : MemoryBudget::of_machine();
}

}  // namespace nutik::app
