#include "media/events/prophesee_events.hpp"

#include <algorithm>
#include <string_view>

#include "capture/text.hpp"

namespace nutik {
namespace {

// A line of a header; what is longer is an event that begins like one.
constexpr std::size_t kLongestLine = 1024;
constexpr std::uint32_t kLargestSensorSide = 1u << 14;

// `EVT3;height=720;width=1280`: a name, and settings of its own.
void add_format(PropheseeHeader& header, std::string_view text) {
  bool is_name = true;
  while (!text.empty()) {
    const auto end = std::min(text.find(';'), text.size());
    const std::string_view part = trimmed(text.substr(0, end));
    const auto equals = part.find('=');
    if (is_name) {
      header.values["format"] = std::string(part);
    } else if (equals != part.npos) {
      header.values[in_small_letters(part.substr(0, equals))] = std::string(part.substr(equals + 1));
    }
    is_name = false;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace

std::uint32_t PropheseeHeader::pixels(const std::string& keyword) const {
  const std::uint32_t number = parsed<std::uint32_t>(of(keyword)).value_or(0);
  return number <= kLargestSensorSide ? number : 0;
}

PropheseeHeader read_prophesee_header(std::span<const std::byte> file) {
  const std::string_view text = as_text(file);
  PropheseeHeader header;
  while (text.substr(header.bytes, 2) == "% ") {
    const auto length = text.substr(header.bytes, kLongestLine).find('\n');
    if (length == text.npos) break;
    const std::string_view line = trimmed(text.substr(header.bytes + 2, length - 2));
    header.bytes += length + 1;
    if (line == "end") break;
    const auto blank = std::min(line.find(' '), line.size());
    const std::string keyword = in_small_letters(line.substr(0, blank));
    const std::string_view value = trimmed(line.substr(blank));
    if (keyword == "format") {
      add_format(header, value);
    } else {
      header.values[keyword] = std::string(value);
    }
  }
  const std::string geometry = header.of("geometry");
  if (const auto cross = geometry.find('x'); cross != geometry.npos) {
    header.values.emplace("width", geometry.substr(0, cross));
    header.values.emplace("height", geometry.substr(cross + 1));
  }
  return header;
}

}  // namespace nutik
