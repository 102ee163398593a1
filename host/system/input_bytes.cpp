#include "system/input_bytes.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {
namespace {

constexpr const char* kTitle = "standard input";

std::string read_to_end(std::FILE* stream) {
  std::string bytes;
  std::array<char, 1 << 16> part;
  while (const std::size_t count = std::fread(part.data(), 1, part.size(), stream)) {
    bytes.append(part.data(), count);
  }
  if (std::ferror(stream) != 0)
    throw InputError(format("{} cannot be read: {}", kTitle, std::strerror(errno)));
  if (bytes.empty()) throw InputError(format("{} is empty", kTitle));
  return bytes;
}

}  // namespace

std::string input_title(const std::string& name) { return is_standard_input(name) ? kTitle : name; }

InputBytes::InputBytes(const std::string& name) {
  if (!is_standard_input(name)) {
    bytes_ = file_.emplace(name).bytes();
    return;
  }
  static const std::string all = read_to_end(stdin);
  bytes_ = std::as_bytes(std::span(all));
}

}  // namespace nutik
