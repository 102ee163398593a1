// What a person names as an input: a file, or standard input where the name is `-`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "capture/text.hpp"
#include "system/mapped_file.hpp"

namespace nutik {

[[nodiscard]] inline bool is_standard_input(std::string_view name) { return name == "-"; }

// What messages call it: `standard input`, or the file's name.
[[nodiscard]] std::string input_title(const std::string& name);

// A file that holds what standard input gives, for whoever reads it more than once: /dev/stdin. What is no file there
// is read to its end when this is first called, into one without a name in TMPDIR, else /tmp. Throws InputError where
// it is a terminal, empty, or cannot be read, OutputError where there is no space. Any thread may ask.
[[nodiscard]] const std::filesystem::path& standard_input_file();

// The most that is read of what a person writes: ten million control points have less.
inline constexpr std::size_t kMaxTextBytes = std::size_t{256} << 20;

// Throws InputError where a text has more.
void check_text_bytes(const std::string& title, std::uintmax_t bytes);

// Its bytes. Standard input is read to its end once; whoever asks again gets the same.
class InputBytes {
 public:
  // Throws InputError where it cannot be read, or standard input has more bytes.
  explicit InputBytes(const std::string& name, std::size_t max_piped_bytes = kMaxTextBytes);

  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }
  // Throws InputError where it is longer than a text is.
  [[nodiscard]] std::string_view text() const {
    check_text_bytes(title_, bytes_.size());
    return as_text(bytes_);
  }

 private:
  std::string title_;
  std::optional<MappedFile> file_;
  std::span<const std::byte> bytes_;
};

// The text of what a person writes, a list: a stream without an end, /dev/zero, is none. Throws InputError where it is
// longer, a folder, or cannot be read.
[[nodiscard]] std::string text_up_to(const std::string& name, std::size_t max_bytes);

}  // namespace nutik
