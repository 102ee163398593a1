#include "media/events/prophesee_events.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

namespace nutik {
namespace {

// A line of a header; what is longer is an event that begins like one.
constexpr std::size_t kLongestLine = 1024;
constexpr std::uint32_t kLargestSensorSide = 1u << 14;

std::string small(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return result;
}

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && (text.back() == '\r' || text.back() == ' ')) text.remove_suffix(1);
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  return text;
}

// `EVT3;height=720;width=1280`: a name, and settings of its own.
void add_format(PropheseeHeader& header, std::string_view text) {
  bool is_name = true;
  while (!text.empty()) {
    const auto end = std::min(text.find(';'), text.size());
    const std::string_view part = without_blanks(text.substr(0, end));
    const auto equals = part.find('=');
    if (is_name) {
      header.values["format"] = std::string(part);
    } else if (equals != part.npos) {
      header.values[small(part.substr(0, equals))] = std::string(part.substr(equals + 1));
    }
    is_name = false;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace

std::uint32_t PropheseeHeader::pixels(const std::string& keyword) const {
  const std::string& text = of(keyword);
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_whole = error == std::errc() && end == text.data() + text.size();
  return is_whole && number <= kLargestSensorSide ? number : 0;
}

PropheseeHeader read_prophesee_header(std::span<const std::byte> file) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  PropheseeHeader header;
  while (text.substr(header.bytes, 2) == "% ") {
    const auto length = text.substr(header.bytes, kLongestLine).find('\n');
    if (length == text.npos) break;
    const std::string_view line = without_blanks(text.substr(header.bytes + 2, length - 2));
    header.bytes += length + 1;
    if (line == "end") break;
    const auto blank = std::min(line.find(' '), line.size());
    const std::string keyword = small(line.substr(0, blank));
    const std::string_view value = without_blanks(line.substr(blank));
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
