// Saves what is whole of a .tik that was cut off.
#pragma once

#include <cstdint>
#include <filesystem>

namespace nutik::tik {

struct Recovery {
  std::uint64_t block_count = 0;
  std::uint64_t sample_count = 0;
  std::uint64_t lost_bytes = 0;  // after the last whole block
};

// Copies the whole blocks at the front of a cut-off .tik into a new, complete one. Throws InputError
// where there is none, OutputError where it cannot be written.
Recovery recover(const std::filesystem::path& damaged, const std::filesystem::path& whole);

}  // namespace nutik::tik
