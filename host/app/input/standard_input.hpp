// Functions and masks from a file, or from standard input where their name is `-`.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "app/command_line/options.hpp"
#include "session/functions.hpp"
#include "system/mapped_file.hpp"

namespace nutik::app {

[[nodiscard]] inline bool is_standard_input(const std::string& name) { return name == "-"; }

// What messages call it: `standard input`, or the file's name.
[[nodiscard]] std::string input_title(const std::string& name);

// The bytes of an input. Standard input is read to its end once; whoever asks again gets the same.
class InputBytes {
 public:
  // Throws InputError where it cannot be read.
  explicit InputBytes(const std::string& name);

  [[nodiscard]] std::span<const std::byte> bytes() const;
  [[nodiscard]] std::string_view text() const;

 private:
  std::optional<MappedFile> file_;
};

// Throws InputError that says what was found and what is needed (media/mask_reader.hpp).
[[nodiscard]] Mask read_mask_input(const std::string& name);

// Whether an input is read from standard input. Throws UsageError where two would be.
bool reads_standard_input(const Options& options);

}  // namespace nutik::app
