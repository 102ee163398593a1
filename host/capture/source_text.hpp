// The text of a file that people write, as its bytes are read and as people are shown them.
//
//   in:      the bytes of a file
//   out:     its characters without line ends of Windows and byte-order marks; places; excerpts
//   always:  every line ends in \n, also the last; what is shown is one line of printable UTF-8 and
//            short, whatever the file is made of
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace nutik {

// A place in a text, counted from 1 as editors do; columns count bytes.
struct TextPlace {
  std::size_t line = 0;
  std::size_t column = 0;
  friend auto operator<=>(const TextPlace&, const TextPlace&) = default;
};

// The part of a line round a place, and what puts a ^ under the place when printed below it.
struct Excerpt {
  std::string text;
  std::string indent;
};

// A text as one line of printable UTF-8, whatever it is made of: controls, invisible characters, characters
// that Unicode sets aside, and bytes that are no UTF-8 as escapes (\r, \x1b, \u00a0, \xe9).
[[nodiscard]] std::string printable(std::string_view text);

// The same of a message or a result, whose lines and tabs stay. A terminal obeys what it is sent.
[[nodiscard]] std::string printable_lines(std::string_view text);

// A piece of a file for a message: at most 40 characters and "…", printable.
[[nodiscard]] std::string shown(std::string_view piece);
[[nodiscard]] std::string quoted(std::string_view piece);

class SourceText {
 public:
  explicit SourceText(std::string_view bytes);

  // The offset behind the last \n is the text's end; what is read there and beyond is a \n.
  [[nodiscard]] char operator[](std::size_t at) const { return at < text_.size() ? text_[at] : '\n'; }
  [[nodiscard]] std::size_t size() const { return text_.size(); }
  [[nodiscard]] std::string_view view() const { return text_; }
  [[nodiscard]] std::string_view piece(std::size_t begin, std::size_t end) const {
    return view().substr(begin, end - begin);
  }
  [[nodiscard]] std::size_t line_end(std::size_t at) const { return text_.find('\n', at); }

  // Behind all characters from `at` on, within its line, that an editor shows as blanks or not at
  // all.
  [[nodiscard]] std::size_t behind_invisible(std::size_t at) const;

  [[nodiscard]] TextPlace place_of(std::size_t at) const;
  // Takes the same time on a line of any length.
  [[nodiscard]] Excerpt excerpt(std::size_t at) const;

 private:
  std::string text_;
  std::vector<std::size_t> line_starts_;
};

}  // namespace nutik
