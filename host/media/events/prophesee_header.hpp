// The lines of text that files of Prophesee's cameras begin with: `% keyword value`, until a line that does not begin
// like this or says `% end`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>

namespace nutik {

struct PropheseeHeader {
  std::map<std::string, std::string> values;  // by keyword in small letters; `format`'s own, `height=720`, too
  std::size_t bytes = 0;                      // where the events begin

  [[nodiscard]] const std::string& of(const std::string& keyword) const {
    static const std::string kNone;
    const auto at = values.find(keyword);
    return at == values.end() ? kNone : at->second;
  }
  // 0 if it is missing, or no number of pixels.
  [[nodiscard]] std::uint32_t pixels(const std::string& keyword) const;
};

[[nodiscard]] PropheseeHeader read_prophesee_header(std::span<const std::byte> file);

}  // namespace nutik
