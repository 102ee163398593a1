#include "app/input/memory_budget.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <charconv>

#include "app/text/size_text.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik::app {
namespace {

// Samples that are held at least: two decoded ahead, and a block's worth of one.
constexpr std::uint64_t kLeastSamples = 8;

std::uint64_t machine_memory() {
  return static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
         static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

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

MemoryBudget MemoryBudget::from(const Options& options) {
  return {options.memory ? parse_size(*options.memory) : machine_memory() / 2};
}

void MemoryBudget::check(const CaptureFormat& capture, std::uint32_t block_samples) const {
  const std::uint64_t sample_bytes = capture.sample_bytes();
  if (kLeastSamples * sample_bytes > bytes) {
    throw UsageError(format(
        "{} of memory are too little for pictures of {}, of which {} are held; allow more: --memory {}MB",
        bytes_text(bytes), bytes_text(sample_bytes), kLeastSamples,
        kLeastSamples * sample_bytes / 1'000'000 + 1));
  }
  if (block_samples > 1 && block_samples * sample_bytes > block_bytes()) {
    throw UsageError(
        format("blocks of {} samples take {} each, and about six are held: more than the {} of memory "
               "allowed (--memory); use fewer samples a block (--block-samples {})",
               block_samples, bytes_text(block_samples * sample_bytes), bytes_text(bytes),
               std::max<std::uint64_t>(1, block_bytes() / sample_bytes)));
  }
}

}  // namespace nutik::app
