// A fuzz target: bytes that anybody may have made go through one of the program's readers.
//
//   in:      bytes, and a ceiling of memory
//   always:  they are read, or refused with an Error. Any other exception, a crash, an undefined operation, more memory
//            than the ceiling, or more than ten seconds of CPU are findings
//
// Each target is a source file beside this one; tools/fuzz runs them.
#pragma once

#include <cstddef>
#include <limits>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "capture/text.hpp"

namespace nutik::fuzz {

using Bytes = std::span<const std::byte>;

// What may be allocated at a time: `fixed` bytes, and so many for each byte of the input.
struct MemoryCeiling {
  std::size_t fixed = 0;
  std::size_t per_input_byte = 0;
  // Larger blocks count as far as they are touched, for libraries that reserve room for whatever a file states.
  std::size_t reserved_from = std::numeric_limits<std::size_t>::max();
};

struct Target {
  MemoryCeiling ceiling;
  void (*read)(Bytes input);
  void (*prepare)() = nullptr;  // once, before anything is counted: loads the libraries that reading needs
};

// The one that this program is made of.
extern const Target kTarget;

// Writes the input to a file of that name in a folder of this process, and returns its path.
std::filesystem::path as_file(Bytes input, std::string_view name);

// Ends the process with a finding, unless `holds`.
void demand(bool holds, std::string_view what);

}  // namespace nutik::fuzz
