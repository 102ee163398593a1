#include "exposure/function_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <set>

#include "capture/format.hpp"

namespace nutik {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

// A stretch that reads like a number, a name or a mistyped one: up to the next mark of the grammar.
bool is_word(char c) {
  return !is_blank(c) && c != '\n' && c != ',' && c != ':' && c != '[' && c != ']' && c != '{' &&
         c != '}' && c != '#';
}

// Thrown inside the parser to give up one function and go on with the next.
struct Abandon {};

class Parser {
 public:
  explicit Parser(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    text_.reserve(text.size() + 1);
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\r' && (i + 1 == text.size() || text[i + 1] == '\n')) continue;
      text_.push_back(text[i]);
    }
    if (text_.empty() || text_.back() != '\n') text_.push_back('\n');
    line_starts_.push_back(0);
    for (std::size_t i = 0; i + 1 < text_.size(); ++i) {
      if (text_[i] == '\n') line_starts_.push_back(i + 1);
    }
  }

  FunctionFile parse() {
    if (text_.find('\0') != std::string::npos) {
      at_ = text_.find('\0');
      report(Diagnostic::Severity::error, at_,
             "a zero byte: this is no text file; functions are lines like M0 [0:1], [10000000:1]");
      return std::move(file_);
    }
    while (at_ < text_.size()) parse_line();
    if (seen_.empty() && !file_.has_errors()) {
      report(Diagnostic::Severity::error, 0,
             "no function in this file; a function is a line like M0 [0:1], [10000000:1], [10000001:0]");
    }
    std::stable_sort(file_.diagnostics.begin(), file_.diagnostics.end(),
                     [](const Diagnostic& a, const Diagnostic& b) { return a.place.line < b.place.line; });
    return std::move(file_);
  }

 private:
  // One line outside braces, or a whole function.
  void parse_line() {
    skip_blanks();
    const char first = peek();
    if (first == 'M' && is_digit(peek(1))) {
      try {
        parse_function();
      } catch (const Abandon&) {
        recover();
      }
      return;
    }
    if (first == '[') {
      report(Diagnostic::Severity::error, at_,
             "a line of control points outside braces; to go on over several lines write M0{ … }");
    } else if (first == 'M' && peek(1) != '\n') {
      report(Diagnostic::Severity::warning, at_,
             "taken as a comment: M is not followed by a mask value, as in M128");
    } else if (first == 'm' && is_digit(peek(1))) {
      report(Diagnostic::Severity::warning, at_, "taken as a comment: a function starts with a capital M");
    }
    skip_line();
  }

  void parse_function() {
    const std::size_t start = at_;
    in_braces_ = brace_follows(start);  // for recover(), also where the tag has a mistake
    ++at_;
    const std::uint32_t tag = parse_tag();
    const auto [earlier, is_new] = seen_.emplace(tag, place_of(start).line);
    if (!is_new) {
      note(start, format("M{} stands a second time; the first is on line {}", tag, earlier->second));
    }
    skip_blanks();
    const bool braced = peek() == '{';
    const std::size_t brace = at_;
    if (braced) ++at_;
    FileFunction parsed{GainFunction({{0, 0.0}}), place_of(start), {}};
    std::vector<ControlPoint> points = parse_points(braced, brace, parsed.point_places);
    if (braced) ++at_;  // the closing brace
    in_braces_ = false;
    expect_line_end(braced);

    if (broken_) {
      broken_ = false;
      return;
    }
    parsed.function = GainFunction(std::move(points));
    file_.functions.emplace(static_cast<std::uint8_t>(tag), std::move(parsed));
  }

  std::uint32_t parse_tag() {
    const std::size_t start = at_;
    std::uint32_t tag = 0;
    while (is_digit(peek())) tag = std::min<std::uint32_t>(tag * 10 + take_digit(), 1000);
    if (is_word(peek())) {
      fail(start, format("'M{}' is no mask value; write M and a whole number 0 … 255", word(start)));
    }
    if (tag > 255) {
      fail(start, format("mask value {} is above 255, the largest an 8-bit mask has",
                         std::string_view(text_).substr(start, at_ - start)));
    }
    return tag;
  }

  // The list up to (not including) the closing brace or the end of the line.
  std::vector<ControlPoint> parse_points(bool braced, std::size_t brace, std::vector<TextPlace>& places) {
    std::vector<ControlPoint> points;
    skip_space(braced, brace);
    if (peek() != '[') {
      if (at_list_end(braced)) {
        fail(at_, "a function without control points; write at least one, as in [0:1]");
      }
      fail(at_, format("'{}' where a control point [time:gain] should start", shown(at_)));
    }
    for (;;) {
      places.push_back(place_of(at_ + 1));
      parse_point(points);
      skip_space(braced, brace);
      if (at_list_end(braced)) return points;
      if (peek() == '[') fail(at_, "a comma is missing between two control points");
      if (peek() != ',') {
        fail(at_, format("'{}' after a control point; a comma or the end should follow", shown(at_)));
      }
      const std::size_t comma = at_++;
      skip_space(braced, brace);
      if (at_list_end(braced)) {
        fail(comma, braced ? "a comma with no control point after it"
                           : "a comma at the end of a line; to go on over several lines write M0{ … }");
      }
      if (peek() != '[') {
        fail(at_, format("'{}' where a control point [time:gain] should start", shown(at_)));
      }
    }
  }

  void parse_point(std::vector<ControlPoint>& points) {
    const std::size_t bracket = at_++;
    skip_blanks();
    const std::size_t time_at = at_;
    const std::int64_t time_ns = parse_time();
    skip_blanks();
    if (peek() != ':') {
      fail(at_, format("'{}' where the ':' between time and gain should stand", shown(at_)));
    }
    ++at_;
    skip_blanks();
    const double gain = parse_gain();
    skip_blanks();
    if (peek() != ']') {
      fail(peek() == '\n' ? bracket : at_,
           peek() == '\n' ? std::string("a bracket that is not closed on its line; ']' ends a control point")
                          : format("'{}' where ']' should end the control point", shown(at_)));
    }
    ++at_;
    if (!points.empty() && time_ns <= points.back().time_ns) {
      const std::int64_t before = points.back().time_ns;
      note(time_at, time_ns == before
                        ? format("time {} stands twice; a jump takes 1 ns: write {} for the second", time_ns,
                                 time_ns + 1)
                        : format("time {} is not after {}; control points must be in time order", time_ns,
                                 before));
    }
    points.push_back({time_ns, gain});
  }

  std::int64_t parse_time() {
    const std::size_t start = at_;
    const bool signed_ = peek() == '-' || peek() == '+';
    const bool negative = peek() == '-';
    if (signed_) ++at_;
    std::int64_t time_ns = 0;
    bool any = false, too_large = false;
    while (is_digit(peek())) {
      any = true;
      const std::int64_t digit = take_digit();
      too_large = too_large || time_ns > (kLargestTimeNs - digit) / 10;
      if (!too_large) time_ns = time_ns * 10 + digit;
    }
    if (!any || is_word(peek())) {
      const std::string bad = word(start);
      if (bad.empty()) fail(start, "a time is missing; write whole nanoseconds, as in [10000000:1]");
      fail(start, is_decimal(bad)
                      ? format("time {} is not a whole number of nanoseconds; 10 ms are 10000000", bad)
                      : format("'{}' is no time; write whole nanoseconds without a unit, 10 ms as 10000000",
                               bad));
    }
    if (too_large) {
      fail(start, format("time {} is further than {} ns from the start (126 years)",
                         std::string_view(text_).substr(start, at_ - start), kLargestTimeNs));
    }
    return negative ? -time_ns : time_ns;
  }

  double parse_gain() {
    const std::size_t start = at_;
    const std::string written = word(start);
    if (written.empty()) fail(start, "a gain is missing; write a number, as in [10000000:1]");
    if (!is_decimal(written)) {
      std::string lower = written;
      std::transform(lower.begin(), lower.end(), lower.begin(),
                     [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
      if (lower.find("inf") != std::string::npos || lower.find("nan") != std::string::npos) {
        fail(start, format("gain {} is not finite; gains are numbers up to 1.79e308", written));
      }
      fail(start, format("'{}' is no gain; write a number such as 1, -0.5 or 2e-3", written));
    }
    const double gain = to_double(written);
    if (!std::isfinite(gain)) {
      fail(start, format("gain {} is not finite; gains are numbers up to 1.79e308", written));
    }
    return gain;
  }

  // [+-] digits [. digits] [e [+-] digits], with a digit before or after the point.
  static bool is_decimal(std::string_view text) {
    std::size_t i = 0;
    const auto digits = [&] {
      const std::size_t from = i;
      while (i < text.size() && is_digit(text[i])) ++i;
      return i - from;
    };
    if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
    std::size_t mantissa = digits();
    if (i < text.size() && text[i] == '.') {
      ++i;
      mantissa += digits();
    }
    if (mantissa == 0) return false;
    if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
      ++i;
      if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
      if (digits() == 0) return false;
    }
    return i == text.size();
  }

  // The nearest double: 0 for what is too small, infinity for what is too large.
  static double to_double(std::string_view written) {
    if (written.starts_with('+')) written.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(written.data(), written.data() + written.size(), value);
    if (error != std::errc::result_out_of_range) return value;
    // from_chars does not tell the two apart. The decimal exponent of the first digit that is not 0 does.
    const auto first = written.find_first_of("123456789");
    const auto mark = written.find_first_of("eE");
    const auto point = std::min({written.find('.'), mark, written.size()});
    long exponent = 0;
    if (mark != std::string_view::npos) {
      exponent = std::strtol(std::string(written.substr(mark + 1)).c_str(), nullptr, 10);
    }
    const long place = static_cast<long>(point) - static_cast<long>(first);
    return exponent > -place ? HUGE_VAL : 0.0;
  }

  void expect_line_end(bool braced) {
    skip_blanks();
    if (peek() == '#') skip_to_line_end();
    if (peek() != '\n') {
      fail(at_, format("'{}' after the end of a function; {}", shown(at_),
                       braced ? "the next one starts on a line of its own" : "a comment starts with #"));
    }
    ++at_;
  }

  // After an error: on with the line after the function's end, as far as that can be told.
  void recover() {
    broken_ = false;
    for (;;) {
      const std::size_t line_end = text_.find('\n', at_);
      const std::size_t brace = std::min(text_.find('}', at_), line_end);
      const bool closed = in_braces_ && brace < std::min(text_.find('#', at_), line_end);
      at_ = line_end + 1;
      if (closed || !in_braces_ || at_ >= text_.size()) break;
      skip_blanks();
      if (peek() == 'M' && is_digit(peek(1))) break;
    }
    in_braces_ = false;
  }

  // Blanks; within braces also line ends and comments. Stops at the next function, which a forgotten
  // brace would otherwise swallow.
  void skip_space(bool braced, std::size_t brace) {
    skip_blanks();
    if (!braced) return;
    while (peek() == '\n' || peek() == '#') {
      if (peek() == '#') skip_to_line_end();
      ++at_;
      if (at_ >= text_.size()) {
        at_ = text_.size() - 1;
        in_braces_ = false;
        fail(brace, "a brace that is never closed; '}' ends the function");
      }
      skip_blanks();
      if (peek() == 'M' && is_digit(peek(1))) {
        report(Diagnostic::Severity::error, brace,
               format("a brace that is not closed before the function on line {}; '}}' ends it",
                      place_of(at_).line));
        at_ = text_.rfind('\n', at_);  // recover() goes on behind this line end, at the next function
        in_braces_ = false;
        throw Abandon{};
      }
    }
  }

  // Whether the function that starts at an `M` is written with braces.
  [[nodiscard]] bool brace_follows(std::size_t start) const {
    std::size_t at = start;
    while (is_word(text_[at])) ++at;
    while (is_blank(text_[at])) ++at;
    return text_[at] == '{';
  }

  [[nodiscard]] bool at_list_end(bool braced) const {
    return braced ? peek() == '}' : peek() == '\n' || peek() == '#';
  }

  [[nodiscard]] char peek(std::size_t ahead = 0) const {
    return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\n';
  }
  std::uint32_t take_digit() { return static_cast<std::uint32_t>(text_[at_++] - '0'); }

  void skip_blanks() {
    while (is_blank(peek())) ++at_;
  }
  void skip_to_line_end() { at_ = text_.find('\n', at_); }
  void skip_line() { at_ = text_.find('\n', at_) + 1; }

  // The word from `start` on; moves behind it.
  std::string word(std::size_t start) {
    at_ = start;
    while (is_word(peek())) ++at_;
    return text_.substr(start, at_ - start);
  }

  [[nodiscard]] std::string shown(std::size_t at) const {
    return at >= text_.size() || text_[at] == '\n' ? "end of line" : std::string(1, text_[at]);
  }

  [[nodiscard]] TextPlace place_of(std::size_t at) const {
    at = std::min(at, text_.size() - 1);
    const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), at);
    return {static_cast<std::size_t>(after - line_starts_.begin()), at - *(after - 1) + 1};
  }

  void report(Diagnostic::Severity severity, std::size_t at, std::string message) {
    const TextPlace place = place_of(at);
    const std::size_t line_start = line_starts_[place.line - 1];
    const std::size_t line_end = text_.find('\n', line_start);
    file_.diagnostics.push_back(
        {severity, place, std::move(message), text_.substr(line_start, line_end - line_start)});
  }

  // An error after which the function can still be read on, for more of them.
  void note(std::size_t at, std::string message) {
    report(Diagnostic::Severity::error, at, std::move(message));
    broken_ = true;
  }

  [[noreturn]] void fail(std::size_t at, std::string message) {
    report(Diagnostic::Severity::error, at, std::move(message));
    throw Abandon{};
  }

  std::string text_;  // line ends as \n, with one at the end
  std::vector<std::size_t> line_starts_;
  std::size_t at_ = 0;
  bool in_braces_ = false;
  bool broken_ = false;                        // the current function has an error that was noted
  std::map<std::uint32_t, std::size_t> seen_;  // tag → line, also of functions with errors
  FunctionFile file_;
};

}  // namespace

std::string Diagnostic::text(std::string_view file_name) const {
  // A long line is shown around the place only.
  constexpr std::size_t kShown = 100;
  std::size_t from = 0;
  if (source_line.size() > kShown && place.column > kShown / 2) from = place.column - kShown / 2;
  const std::string_view shown = std::string_view(source_line).substr(from, kShown);
  std::string excerpt = from > 0 ? "… " : "";
  std::string mark(from > 0 ? 2 : 0, ' ');
  for (std::size_t i = from; i + 1 < place.column; ++i) {
    mark.push_back(i < source_line.size() && source_line[i] == '\t' ? '\t' : ' ');
  }
  excerpt += shown;
  if (from + shown.size() < source_line.size()) excerpt += " …";
  return format("{}:{}:{}: {}{}\n    {}\n    {}^", file_name, place.line, place.column,
                severity == Severity::warning ? "warning: " : "", message, excerpt, mark);
}

bool FunctionFile::has_errors() const {
  return std::any_of(diagnostics.begin(), diagnostics.end(), [](const Diagnostic& diagnostic) {
    return diagnostic.severity == Diagnostic::Severity::error;
  });
}

std::string FunctionFile::report(Diagnostic::Severity severity, std::string_view file_name) const {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) {
    if (diagnostic.severity != severity) continue;
    if (!text.empty()) text.push_back('\n');
    text += diagnostic.text(file_name);
  }
  return text;
}

FunctionFile parse_functions(std::string_view text) { return Parser(text).parse(); }

}  // namespace nutik
