#include "system/input_bytes.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "system/interruption.hpp"
#include "system/temporary_folder.hpp"

namespace nutik {
namespace {

constexpr const char* kTitle = "standard input";
constexpr const char* kFile = "/dev/stdin";

[[noreturn]] void fail_long(const std::string& title, std::size_t max_bytes) {
  throw InputError(format("{} is longer than {} MiB; {}", title, max_bytes >> 20,
                          max_bytes > kMaxTextBytes ? "name a file" : "no text that a person writes is"));
}

std::string read_to_end(std::FILE* stream, std::size_t max_bytes) {
  std::string bytes;
  std::array<char, 1 << 16> part;
  while (const std::size_t count = std::fread(part.data(), 1, part.size(), stream)) {
    check_interruption();
    if (count > max_bytes - bytes.size()) fail_long(kTitle, max_bytes);
    bytes.append(part.data(), count);
  }
  if (std::ferror(stream) != 0)
    throw InputError(format("{} cannot be read: {}", kTitle, std::strerror(errno)));
  if (bytes.empty()) throw InputError(format("{} is empty", kTitle));
  return bytes;
}

// Takes the place of standard input.
void keep_standard_input() {
  struct stat input {};
  if (isatty(STDIN_FILENO) == 1) {
    throw InputError(format("{} is a terminal; send a clip there: ffmpeg … -f yuv4mpegpipe - | …", kTitle));
  }
  if (fstat(STDIN_FILENO, &input) == 0 && S_ISREG(input.st_mode)) return;
  const NamelessFile file;
  const auto fail = [](int reason) {
    throw OutputError(
        format("{} cannot be kept in {}: {}", kTitle, temporary_folder().string(), std::strerror(reason)));
  };
  std::array<char, 1 << 16> part;
  std::uint64_t bytes = 0;
  for (;;) {
    check_interruption();
    const ssize_t count = read(STDIN_FILENO, part.data(), part.size());
    if (count == 0) break;
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw InputError(format("{} cannot be read: {}", kTitle, std::strerror(errno)));
    for (ssize_t at = 0; at < count;) {
      const ssize_t written =
          write(file.descriptor(), part.data() + at, static_cast<std::size_t>(count - at));
      if (written < 0 && errno != EINTR) fail(errno);
      at += std::max<ssize_t>(written, 0);
    }
    bytes += static_cast<std::uint64_t>(count);
  }
  if (bytes == 0) throw InputError(format("{} is empty", kTitle));
  if (dup2(file.descriptor(), STDIN_FILENO) < 0) fail(errno);
}

}  // namespace

const std::filesystem::path& standard_input_file() {
  static const std::filesystem::path file = [] {
    keep_standard_input();
    return std::filesystem::path(kFile);
  }();
  return file;
}

std::string input_title(const std::string& name) {
  return is_standard_input(name) || name == kFile ? kTitle : name;
}

void check_text_bytes(const std::string& title, std::uintmax_t bytes) {
  if (bytes > kMaxTextBytes) fail_long(title, kMaxTextBytes);
}

InputBytes::InputBytes(const std::string& name, std::size_t max_piped_bytes) : title_(input_title(name)) {
  if (!is_standard_input(name)) {
    bytes_ = file_.emplace(name).bytes();
    return;
  }
  static const std::string all = read_to_end(stdin, max_piped_bytes);
  bytes_ = std::as_bytes(std::span(all));
}

std::string text_up_to(const std::string& name, std::size_t max_bytes) {
  const std::string title = input_title(name);
  std::error_code ignored;
  if (std::filesystem::is_directory(name, ignored))
    throw InputError(format("{} is a folder, not a list", title));
  std::ifstream file;
  std::istream& stream = is_standard_input(name) ? std::cin : file;
  if (!is_standard_input(name)) file.open(name);
  if (!stream) throw InputError(format("{} cannot be opened", title));
  std::string text;
  for (std::array<char, 1 << 16> part; stream.read(part.data(), part.size()), stream.gcount() > 0;) {
    check_interruption();
    text.append(part.data(), static_cast<std::size_t>(stream.gcount()));
    if (text.find('\0', text.size() - static_cast<std::size_t>(stream.gcount())) != text.npos)
      throw InputError(
          format("{} is no list: it is no text. batch takes the list first, then the clip or capture", title));
    if (text.size() <= max_bytes) continue;
    throw InputError(format("{} is longer than {} MiB; make several of it", title, max_bytes >> 20));
  }
  if (stream.bad()) throw InputError(format("{} cannot be read", title));
  return text;
}

}  // namespace nutik
