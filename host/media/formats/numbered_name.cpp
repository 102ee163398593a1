#include "media/formats/numbered_name.hpp"

#include <algorithm>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {

std::optional<NumberedName> NumberedName::parse(const std::string& name) {
  constexpr std::size_t kTooWide = 256;  // for a name: the file system says so
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  for (auto percent = name.find('%'); percent != std::string::npos; percent = name.find('%', percent + 1)) {
    NumberedName numbered{name.substr(0, percent), {}, 0, ' '};
    std::size_t at = percent + 1;
    if (at < name.size() && name[at] == '0') numbered.fill = '0';
    for (; at < name.size() && is_digit(name[at]); ++at) {
      numbered.width =
          std::min<std::size_t>(numbered.width * 10 + static_cast<std::size_t>(name[at] - '0'), kTooWide);
    }
    if (at >= name.size() || (name[at] != 'd' && name[at] != 'i' && name[at] != 'u')) continue;
    numbered.after = name.substr(at + 1);
    return numbered;
  }
  return std::nullopt;
}

void NumberedName::expect_one(const std::string& name) const {
  if (parse(after)) throw UsageError(format("{} has a place for two numbers, and pictures are numbered once", name));
}

std::string NumberedName::with(const std::string& digits) const {
  return before + std::string(width > digits.size() ? width - digits.size() : 0, fill) + digits + after;
}

}  // namespace nutik
