#include "capture/source_text.hpp"

#include <algorithm>
#include <array>

#include "capture/format.hpp"

namespace nutik {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::size_t kLongestPiece = 40;     // characters in a message
constexpr std::size_t kLongestExcerpt = 100;  // bytes
constexpr std::string_view kCut = "…";

struct Character {
  char32_t code = 0;
  std::size_t bytes = 1;
  bool is_utf8 = false;  // else one byte, its value in `code`
};

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

// The first character of a text that is not empty.
Character first_character(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  const Character byte{lead, 1, lead < 0x80};
  const std::size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < bytes) return byte;
  char32_t code = lead & (0xFFu >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) {
    if (!is_continuation(text[i])) return byte;
    code = code << 6 | (static_cast<unsigned char>(text[i]) & 0x3F);
  }
  constexpr std::array<char32_t, 5> kSmallest = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < kSmallest[bytes] || is_surrogate || code > 0x10FFFF) return byte;
  return {code, bytes, true};
}

// Controls, blanks that look like a space but are none, what terminals do not show or obey, and the codes that
// Unicode keeps from being characters.
bool is_invisible(char32_t code) {
  struct Range {
    char32_t first, last;
  };
  constexpr Range kInvisible[] = {
      {0x00, 0x1F},     {0x7F, 0xA0},     {0xAD, 0xAD},     {0x061C, 0x061C},   {0x180E, 0x180E},
      {0x2000, 0x200F}, {0x2028, 0x202F}, {0x205F, 0x206F}, {0x3000, 0x3000},   {0xFE00, 0xFE0F},
      {0xFDD0, 0xFDEF}, {0xFEFF, 0xFEFF}, {0xFFF0, 0xFFFB}, {0xE0000, 0xE0FFF},
  };
  if ((code & 0xFFFE) == 0xFFFE) return true;
  return std::any_of(std::begin(kInvisible), std::end(kInvisible),
                     [&](const Range& range) { return code >= range.first && code <= range.last; });
}

std::string printable(std::string_view text, const Character& character) {
  const auto code = static_cast<std::uint32_t>(character.code);
  if (character.is_utf8 && !is_invisible(character.code)) {
    return std::string(text.substr(0, character.bytes));
  }
  if (code == '\t') return "\\t";
  if (code == '\r') return "\\r";
  if (!character.is_utf8 || code < 0x80) return format("\\x{:02x}", code);
  return code > 0xFFFF ? format("\\U{:08x}", code) : format("\\u{:04x}", code);
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const Character character = first_character(text);
    result += printable(text, character);
    text.remove_prefix(character.bytes);
  }
  return result;
}

std::string printable_lines(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\n\t"), text.size());
    result += printable(text.substr(0, end));
    if (end < text.size()) result += text[end];
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return result;
}

std::string shown(std::string_view piece) {
  std::string text;
  for (std::size_t count = 0; !piece.empty(); ++count) {
    if (count == kLongestPiece) return text.append(kCut);
    const Character character = first_character(piece);
    text += printable(piece, character);
    piece.remove_prefix(character.bytes);
  }
  return text;
}

std::string quoted(std::string_view piece) { return format("'{}'", shown(piece)); }

SourceText::SourceText(std::string_view bytes) {
  text_.reserve(bytes.size() + 1);
  line_starts_.push_back(0);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    // Files that were put one behind the other have byte-order marks in their middle, too.
    if (text_.size() == line_starts_.back() && bytes.substr(i).starts_with(kByteOrderMark)) {
      i += kByteOrderMark.size() - 1;
      continue;
    }
    if (bytes[i] == '\r' && (i + 1 == bytes.size() || bytes[i + 1] == '\n')) continue;
    text_.push_back(bytes[i]);
    if (bytes[i] == '\n') line_starts_.push_back(text_.size());
  }
  if (text_.empty() || text_.back() != '\n') {
    text_.push_back('\n');
  } else {
    line_starts_.pop_back();
  }
}

std::size_t SourceText::behind_invisible(std::size_t at) const {
  while ((*this)[at] != '\n') {
    const Character character = first_character(view().substr(at));
    const bool is_seen = character.code != ' ' && !(character.is_utf8 && is_invisible(character.code));
    if (is_seen) break;
    at += character.bytes;
  }
  return at;
}

TextPlace SourceText::place_of(std::size_t at) const {
  const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), at);
  return {static_cast<std::size_t>(after - line_starts_.begin()), at - *(after - 1) + 1};
}

Excerpt SourceText::excerpt(std::size_t at) const {
  const std::size_t line_start = at + 1 - place_of(at).column;
  std::size_t from = line_start;
  if (at - line_start > kLongestExcerpt / 2) {
    from = at - kLongestExcerpt / 2;
    while (from < at && is_continuation(text_[from])) ++from;
  }
  Excerpt excerpt;
  if (from > line_start) {
    excerpt.text.append(kCut).append(" ");
    excerpt.indent = "  ";
  }
  std::size_t next = from;
  while (text_[next] != '\n' && next < from + kLongestExcerpt) {
    const std::string_view rest = view().substr(next);
    const Character character = first_character(rest);
    const bool is_tab = character.code == '\t';
    const std::string text = is_tab ? "\t" : printable(rest, character);
    excerpt.text += text;
    if (next < at) {
      const bool is_itself = text.size() == character.bytes;  // one column wide; escapes are as wide as long
      excerpt.indent += is_tab ? "\t" : std::string(is_itself ? 1 : text.size(), ' ');
    }
    next += character.bytes;
  }
  if (text_[next] != '\n') excerpt.text.append(" ").append(kCut);
  return excerpt;
}

}  // namespace nutik
