// A capture beside the clip that it was made from.
#pragma once

#include <cstdint>
#include <filesystem>

#include "app/command_line/options.hpp"
#include "imev/source_comparison.hpp"
#include "tik/reader.hpp"

namespace nutik::app {

struct SourceCheck {
  SourceComparison comparison;
  std::uint64_t record_count = 0;  // change records that the capture keeps
  std::uint64_t file_bytes = 0;    // of the capture
  std::uint64_t source_bytes = 0;  // of the samples, unpacked
  bool clip_goes_on = false;       // after the capture's last sample
};

// Reads both to the capture's end. What the clip's codes are is taken from the capture; --white and --raw say it
// otherwise. Throws InputError where the clip's pictures are not those of the capture, or too few.
[[nodiscard]] SourceCheck compare_with_source(tik::Reader& capture, const std::filesystem::path& clip,
                                              const Options& options);

}  // namespace nutik::app
