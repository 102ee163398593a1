// Small pieces of text: numbers, blanks, letters, lists; and bytes as such.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace nutik {

[[nodiscard]] inline std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// A number of so many bytes, the most significant first; 0 where they are not all there.
[[nodiscard]] inline std::uint64_t big_endian(std::string_view bytes, std::size_t at, std::size_t count) {
  if (at > bytes.size() || bytes.size() - at < count) return 0;
  std::uint64_t number = 0;
  for (const char byte : bytes.substr(at, count)) number = number << 8 | static_cast<unsigned char>(byte);
  return number;
}

// A number at the start of a text, which is cut off. False: there is none.
template <typename Number>
[[nodiscard]] bool take_number(std::string_view& text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return error == std::errc();
}

// The number that is all of a text; empty: it is none.
template <typename Number>
[[nodiscard]] std::optional<Number> parsed(std::string_view text) {
  Number number{};
  return take_number(text, number) && text.empty() ? std::optional(number) : std::nullopt;
}

[[nodiscard]] inline std::string_view trimmed(std::string_view text, std::string_view blanks = " \t\r\n") {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

// A to Z made small, whatever the locale.
[[nodiscard]] inline std::string in_small_letters(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return small;
}

// `a, b, c`; what is not text itself is made so by `text_of`.
template <typename Parts, typename TextOf = std::identity>
[[nodiscard]] std::string joined(const Parts& parts, std::string_view between = ", ", TextOf text_of = {}) {
  std::string text;
  bool is_first = true;
  for (const auto& part : parts) (text += std::exchange(is_first, false) ? "" : between) += std::invoke(text_of, part);
  return text;
}

// `a, b or c`
[[nodiscard]] inline std::string alternatives(std::span<const std::string> parts) {
  if (parts.size() < 2) return joined(parts);
  return joined(parts.first(parts.size() - 1)) + " or " + parts.back();
}

// What stands between separators: lines, words. joined() puts it together again.
[[nodiscard]] inline std::vector<std::string> parts_of(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const std::string_view part = text.substr(0, text.find(separator));
    parts.emplace_back(part);
    text.remove_prefix(std::min(part.size() + 1, text.size()));
  }
  return parts;
}

}  // namespace nutik
