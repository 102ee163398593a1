#include "app/input/standard_input.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string_view>

#include "app/command_line/option_table.hpp"
#include "session/error.hpp"
#include "session/format.hpp"
#include "session/pictures.hpp"

namespace nutik::app {
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

const std::string& standard_input() {
  static const std::string bytes = read_to_end(stdin);
  return bytes;
}

}  // namespace

std::string input_title(const std::string& name) { return is_standard_input(name) ? kTitle : name; }

InputBytes::InputBytes(const std::string& name) {
  if (is_standard_input(name)) {
    static_cast<void>(standard_input());
  } else {
    file_.emplace(name);
  }
}

std::span<const std::byte> InputBytes::bytes() const {
  return file_ ? file_->bytes() : std::as_bytes(std::span(standard_input()));
}

std::string_view InputBytes::text() const {
  return {reinterpret_cast<const char*>(bytes().data()), bytes().size()};
}

Mask read_mask_input(const std::string& name) {
  const InputBytes input(name);
  return Mask::from_picture(read_mask(input.bytes(), input_title(name)));
}

bool reads_standard_input(const Options& options) {
  const Option* first = nullptr;
  for (const Option& option : app::options()) {
    const std::string* name = option.reads_standard_input() ? option.stated(options) : nullptr;
    if (name == nullptr || !is_standard_input(*name)) continue;
    if (first != nullptr) {
      throw UsageError(format("{} - and {} - would both read standard input; name a file for one",
                              first->display_name(), option.display_name()));
    }
    first = &option;
  }
  return first != nullptr;
}

}  // namespace nutik::app
