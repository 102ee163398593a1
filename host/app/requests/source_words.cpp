#include "app/requests/source_words.hpp"

#include "app/text/number_text.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik::app {

MemoryBudget memory_budget(const Options& options) {
  if (!options.memory) return MemoryBudget::of_machine();
  const std::optional<std::uint64_t> stated = parse_bytes(*options.memory);
  if (!stated || *stated == 0)
    throw UsageError(format("--memory '{}' is no size; write 500MB, 2GB or 1GiB", *options.memory));
  return MemoryBudget{*stated};
}

}  // namespace nutik::app
