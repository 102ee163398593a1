#include "exposure/function_file.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "capture/format.hpp"
#include "capture/source_text.hpp"
#include "exposure/function_numbers.hpp"
#include "exposure/function_template.hpp"
#include "system/interruption.hpp"

namespace nutik {
namespace {

using Severity = Diagnostic::Severity;

constexpr std::string_view kNoFunction =
    "no function in this file; a function is a line like M0 [0:1], [10000000:1], [10000001:0]";
constexpr std::string_view kOldLineEnds =
    "; its lines end in carriage returns: save it with line ends of Unix or Windows";
constexpr std::string_view kLoneCarriageReturn =
    "a carriage return without a line feed; save the file with line ends of Unix or Windows";
constexpr std::string_view kWriteBraces = "to go on over several lines write M0{ … }";

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c & 0x80) != 0; }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

// A stretch that reads like a number, a name or a mistyped one: up to the next mark of the grammar.
bool is_word(char c) {
  return !is_blank(c) && c != '\n' && c != ',' && c != ':' && c != '[' && c != ']' && c != '{' && c != '}' &&
         c != '#';
}

// Thrown inside the parser to give up one function and go on with the next.
struct Abandon {};

class Parser {
 public:
  // Names in place of numbers are mistakes, unless there is a template to keep them in.
  explicit Parser(std::string_view bytes, FunctionTemplate* names = nullptr) : text_(bytes), names_(names) {}

  // The text that places are in.
  [[nodiscard]] std::string_view text() const { return text_.view(); }

  FunctionFile parse() {
    if (const auto zero = text_.view().find('\0'); zero != std::string_view::npos) {
      report(Severity::error, zero,
             "a zero byte: this is no text file, or one in UTF-16; save it as UTF-8 or plain ASCII");
      return std::move(file_);
    }
    while (at_ < text_.size()) parse_line();
    for (const auto& [tag, line] : first_lines_) {
      if (!file_.functions.contains(tag)) file_.broken.insert(tag);
    }
    if (first_lines_.empty() && !file_.has_errors()) {
      const std::string_view view = text_.view();
      const bool is_one_line = view.find('\n') + 1 == view.size() && view.find('\r') < view.size();
      report(Severity::error, 0, format("{}{}", kNoFunction, is_one_line ? kOldLineEnds : ""));
    }
    return std::move(file_);
  }

 private:
  // One line outside braces, or a whole function.
  void parse_line() {
    skip_blanks();
    if (is_function_start(at_) || is_picture_length()) {
      try {
        peek() == 'M' ? parse_function() : parse_picture_length();
      } catch (const Abandon&) {
        recover();
      }
      return;
    }
    if (peek() == '[') {
      report(Severity::error, at_, format("a line of control points outside braces; {}", kWriteBraces));
    } else if (const std::string warning = comment_warning(); !warning.empty()) {
      report(Severity::warning, at_, "taken as a comment: " + warning);
    }
    at_ = text_.line_end(at_) + 1;
  }

  // What may be wrong with a comment line; empty where it looks like any other.
  [[nodiscard]] std::string comment_warning() const {
    if (peek() == 'M') return "M is not followed by a mask value, as in M128";
    if (peek() == 'm' && is_digit(peek(1))) return "a function starts with a capital M";
    if ((peek() == ',' || peek() == '{') && text_[behind_blanks(at_ + 1)] == '[') {
      return format("control points outside braces; {}", kWriteBraces);
    }
    // No-break spaces and byte-order marks are not seen in an editor.
    const std::size_t at = text_.behind_invisible(at_);
    if (at > at_ && is_function_start(at)) {
      return format("{} stands before the M of a function", quoted(text_.piece(at_, at)));
    }
    return {};
  }

  // `1f = 1/240s`
  [[nodiscard]] bool is_picture_length() const {
    return peek() == '1' && peek(1) == 'f' && text_[behind_blanks(at_ + 2)] == '=';
  }

  void parse_picture_length() {
    const std::size_t start = at_;
    at_ = behind_blanks(behind_blanks(at_ + 2) + 1);
    const std::size_t length_at = at_;
    for (take_word(); peek() == ':'; take_word()) ++at_;
    const StatedTime length = number_or_fail(read_picture_length(text_.piece(length_at, at_)), length_at);
    if (std::exchange(picture_, length)) fail(start, "the length of a picture is stated twice");
    expect_line_end("a picture's length");
  }

  void parse_function() {
    const std::size_t start = at_;
    brace_ = brace_of(start);
    ++at_;
    const std::size_t value_at = at_;
    const std::uint8_t tag = number_or_fail(read_mask_value(take_word()), value_at);
    const auto [first, is_new] = first_lines_.emplace(tag, text_.place_of(start).line);
    if (!is_new) {
      note(start,
           format("M{} has a function already, on line {}; each mask value has one", tag, first->second));
    }
    skip_blanks();
    is_braced_ = peek() == '{';
    if (is_braced_) ++at_;
    std::vector<ControlPoint> points = parse_points();
    if (is_braced_) ++at_;  // the closing brace
    brace_.reset();
    expect_line_end();
    if (std::exchange(is_broken_, false)) return;
    if (names_ != nullptr) {
      names_->functions.emplace(tag, std::move(template_points_));
    } else {
      file_.functions.emplace(tag, FileFunction{GainFunction(std::move(points)), text_.place_of(start), start,
                                                std::move(time_at_)});
    }
  }

  // The list up to (not including) the closing brace or the end of the line.
  std::vector<ControlPoint> parse_points() {
    std::vector<ControlPoint> points;
    time_at_.clear();
    template_points_.clear();
    skip_space();
    if (at_list_end()) fail_without_points();
    for (;;) {
      if (peek() != '[') {
        fail_at_other("where a control point [time:gain] should start",
                      is_letter(peek()) ? "; a comment starts with #" : "");
      }
      parse_point(points);
      skip_space();
      if (at_list_end()) return points;
      if (peek() == '[') fail(at_, "a comma is missing between two control points");
      if (peek() != ',') fail_after_point();
      const std::size_t comma = at_++;
      skip_space();
      if (at_list_end()) {
        constexpr std::string_view kWhat = "a comma with no control point after it";
        fail(comma, is_braced_ ? std::string(kWhat) : format("{}; {}", kWhat, kWriteBraces));
      }
    }
  }

  void parse_point(std::vector<ControlPoint>& points) {
    if (points.size() % 1024 == 0) check_interruption();
    const std::size_t bracket = at_++;
    skip_blanks();
    const std::size_t time_at = at_;
    if (!is_word(peek())) fail_without_number("time", "whole nanoseconds");
    const Named named_time = take_name(&FunctionTemplate::Place::time);
    const std::int64_t time_ns =
        named_time.name ? named_time.added_ns : number_or_fail(read_time(take_time(), picture_), time_at);
    skip_blanks();
    if (peek() != ':') {
      const std::size_t rest = peek() == ',' ? behind_blanks(at_ + 1) : at_;
      const bool is_split = word_end(rest) > rest && text_[behind_blanks(word_end(rest))] == ':';
      const std::string with_point =
          std::string(text_.piece(time_at, at_)).append(".").append(text_.piece(rest, word_end(rest)));
      const bool has_comma = is_split && peek() == ',' && read_time(with_point, picture_).mistake.empty();
      fail_at_other("where the ':' between time and gain should stand",
                    has_comma  ? format("; the decimal mark is a point: write {}", with_point)
                    : is_split ? "; a time is one word: 10000000 or 10ms"
                               : "");
    }
    ++at_;
    skip_blanks();
    const std::size_t gain_at = at_;
    if (!is_word(peek())) fail_without_number("gain", "a number");
    const Named named_gain = take_name(&FunctionTemplate::Place::gain);
    const std::string_view gain_word = named_gain.name ? std::string_view() : take_word();
    const double gain = named_gain.name ? 0.0 : number_or_fail(read_gain(gain_word), gain_at);
    skip_blanks();
    if (peek() == '\n') fail(bracket, "a bracket that is not closed on its line; ']' ends a control point");
    if (peek() != ']') fail_at_other("where ']' should end the control point", split_gain_way_out(gain_word));
    ++at_;
    // Named times are in order or not when they are known; of one name that is known here.
    const bool is_comparable =
        template_points_.empty() || template_points_.back().time_name == named_time.name;
    if (!points.empty() && is_comparable && time_ns <= points.back().time_ns)
      note_disorder(time_at, points.back().time_ns, time_ns);
    if (names_ != nullptr) template_points_.push_back({time_ns, gain, named_time.name, named_gain.name});
    points.push_back({time_ns, gain});
    time_at_.push_back(time_at);
  }

  struct Named {
    std::optional<std::size_t> name;
    std::int64_t added_ns = 0;
  };

  // A name in the place of a number, `rest`, of a time also `when+10000000`; none where a number stands, or names are
  // not to be kept.
  Named take_name(std::optional<std::size_t> FunctionTemplate::Place::*kind) {
    if (names_ == nullptr || !is_letter(peek())) return {};
    const std::size_t at = at_;
    const std::string_view word = take_word();
    const bool is_time = kind == &FunctionTemplate::Place::time;
    const std::string_view name = word.substr(0, word.find_first_of("+-"));
    const auto is_part = [](char c) { return is_digit(c) || c == '_' || ((c & 0x80) == 0 && is_letter(c)); };
    if (!std::ranges::all_of(name, is_part) || name == "inf" || name == "nan" || (!is_time && name != word)) {
      fail(at,
           format(
               "{} is neither a number nor a name; a name has letters, digits and _, and a time's may go on "
               "with +TIME",
               quoted(word)));
    }
    Named named;
    if (name != word) named.added_ns = number_or_fail(read_time(word.substr(name.size()), picture_), at);
    std::vector<std::string>& known = is_time ? names_->times : names_->gains;
    if (std::ranges::count(is_time ? names_->gains : names_->times, name) > 0) {
      note(at, format("{} stands for a gain and for a time; give one of them another name", quoted(name)));
    }
    const auto found = std::ranges::find(known, name);
    named.name = static_cast<std::size_t>(found - known.begin());
    if (found == known.end()) known.emplace_back(name);
    FunctionTemplate::Place place{at, at_, {}, {}, named.added_ns};
    place.*kind = named.name;
    names_->places.push_back(place);
    return named;
  }

  void note_disorder(std::size_t at, std::int64_t before_ns, std::int64_t time_ns) {
    if (time_ns < before_ns) {
      note(at, format("time {} is not after {}; control points must be in time order", time_ns, before_ns));
      return;
    }
    const bool is_last = time_ns == kLargestTimeNs;
    note(at, format("time {} stands twice; a jump takes 1 ns: write {} for the {}", time_ns,
                    is_last ? time_ns - 1 : time_ns + 1, is_last ? "first" : "second"));
  }

  // For a gain that is not followed by its bracket but by more of a number.
  [[nodiscard]] std::string split_gain_way_out(std::string_view gain) const {
    const bool has_comma = peek() == ',';
    const std::size_t begin = has_comma ? behind_blanks(at_ + 1) : at_;
    const std::size_t end = word_end(begin);
    if (begin == end || text_[behind_blanks(end)] != ']') return {};
    if (!has_comma) return "; a gain is one number, without blanks or a unit";
    const std::string_view decimals = text_.piece(begin, end);
    const std::string with_point = std::string(gain).append(".").append(decimals);
    const bool is_number = is_digit(decimals[0]) && read_gain(with_point).mistake.empty();
    return is_number ? format("; the decimal mark is a point: write {}", shown(with_point)) : "";
  }

  void expect_line_end(std::string_view what = "a function") {
    skip_blanks();
    if (peek() == '#') at_ = text_.line_end(at_);
    if (peek() != '\n') {
      fail_at_other(format("after the end of {}", what), is_function_start(at_)
                                                             ? "; another function starts on a line of its own"
                                                             : "; only a comment that starts with # may follow");
    }
    ++at_;
  }

  [[noreturn]] void fail_without_points() {
    constexpr std::string_view kWhat = "a function without control points";
    if (is_braced_ || !brace_) fail(at_, format("{}; write at least one, as in [0:1]", kWhat));
    const std::size_t list_at = std::exchange(at_, *brace_);
    fail(list_at, format("{}; the '{{' of line {} belongs on the line of the M, as in M0{{ … }}", kWhat,
                         text_.place_of(*brace_).line));
  }

  [[noreturn]] void fail_after_point() {
    if (is_function_start(at_)) {
      fail_at_other("after a control point", "; another function starts on a line of its own");
    }
    if (peek() == '}') {
      fail_at_other("after a control point", "; no brace is open before it, as in M0{ … }");
    }
    fail_at_other("after a control point",
                  is_braced_ ? "; a comma or '}' should follow, and a comment starts with #"
                             : "; a comma or the line's end should follow, and a comment starts with #");
  }

  [[noreturn]] void fail_without_number(std::string_view name, std::string_view what) {
    const std::string way_out = format("; write {}, as in [10000000:1]", what);
    if ((peek() == ':' && name == "time") || peek() == ']' || peek() == '\n') {
      fail(at_, format("a {} is missing{}", name, way_out));
    }
    fail_at_other(format("where a {} should stand", name), way_out);
  }

  // An error at a word or mark that should not stand where it does.
  [[noreturn]] void fail_at_other(std::string_view where, std::string_view way_out) {
    if (peek() == '\r') fail(at_, std::string(kLoneCarriageReturn));
    const std::size_t end = is_word(peek()) ? word_end(at_) : at_ + 1;
    fail(at_, format("{} {}{}", peek() == '\n' ? "the end of the line" : quoted(text_.piece(at_, end)), where,
                     way_out));
  }

  template <typename Number>
  Number number_or_fail(ReadNumber<Number> read, std::size_t at) {
    if (!read.mistake.empty()) fail(at, std::move(read.mistake));
    return read.value;
  }

  // After an error: on with the line after the function's end, as far as that can be told.
  void recover() {
    is_broken_ = false;
    for (;;) {
      const std::string_view rest = text_.piece(at_, text_.line_end(at_));
      at_ += rest.size() + 1;
      if (!brace_ || rest.substr(0, rest.find('#')).find('}') != std::string_view::npos) break;
      if (at_ >= text_.size() || is_function_start(behind_blanks(at_))) break;
    }
    brace_.reset();
  }

  // Blanks; within braces also line ends and comments. Stops at the next function, which a
  // forgotten brace would otherwise swallow.
  void skip_space() {
    skip_blanks();
    if (!is_braced_) return;
    while (peek() == '\n' || peek() == '#') {
      const std::size_t line_end = text_.line_end(at_);
      at_ = behind_blanks(line_end + 1);
      if (at_ < text_.size() && !is_function_start(at_)) continue;
      const std::string what =
          at_ < text_.size()
              ? format("a brace that is not closed before the function on line {}", text_.place_of(at_).line)
              : "a brace that is never closed";
      at_ = line_end;  // recover() goes on behind it
      const std::size_t brace = *std::exchange(brace_, std::nullopt);
      fail(brace, what + "; '}' ends the function");
    }
  }

  // The opening brace of the function that starts at an `M`, also one that has slipped to a later
  // line.
  [[nodiscard]] std::optional<std::size_t> brace_of(std::size_t start) const {
    std::size_t at = behind_blanks(word_end(start));
    while (at < text_.size() && (text_[at] == '\n' || text_[at] == '#')) {
      at = behind_blanks(text_.line_end(at) + 1);
    }
    return text_[at] == '{' ? std::optional(at) : std::nullopt;
  }

  [[nodiscard]] bool is_function_start(std::size_t at) const {
    return text_[at] == 'M' && is_digit(text_[at + 1]);
  }
  [[nodiscard]] bool at_list_end() const {
    return is_braced_ ? peek() == '}' : peek() == '\n' || peek() == '#';
  }

  [[nodiscard]] char peek(std::size_t ahead = 0) const { return text_[at_ + ahead]; }
  [[nodiscard]] std::size_t behind_blanks(std::size_t at) const {
    while (is_blank(text_[at])) ++at;
    return at;
  }
  [[nodiscard]] std::size_t word_end(std::size_t at) const {
    while (is_word(text_[at])) ++at;
    return at;
  }
  void skip_blanks() { at_ = behind_blanks(at_); }
  std::string_view take_word() {
    const std::size_t start = std::exchange(at_, word_end(at_));
    return text_.piece(start, at_);
  }

  // A word; of a time such as 0:01.5 all that stands before the last colon.
  std::string_view take_time() {
    const std::size_t start = at_;
    take_word();
    for (std::size_t end = 0; peek() == ':' && is_digit(peek(1)) && text_[end = word_end(at_ + 1)] == ':';) at_ = end;
    return text_.piece(start, at_);
  }

  void report(Severity severity, std::size_t at, std::string message) {
    file_.diagnostics.add(severity, text_, at, std::move(message));
  }

  // An error after which the function can still be read on, for more of them.
  void note(std::size_t at, std::string message) {
    report(Severity::error, at, std::move(message));
    is_broken_ = true;
  }

  [[noreturn]] void fail(std::size_t at, std::string message) {
    report(Severity::error, at, std::move(message));
    throw Abandon{};
  }

  SourceText text_;
  FunctionTemplate* names_;
  std::size_t at_ = 0;
  FunctionFile file_;
  std::map<std::uint8_t, std::size_t> first_lines_;  // by mask value, also of functions with errors
  std::optional<StatedTime> picture_;                // how long one is

  // The current function's:
  std::optional<std::size_t> brace_;  // its opening brace, until it is closed
  bool is_braced_ = false;
  bool is_broken_ = false;  // it has an error that was noted
  std::vector<std::size_t> time_at_;
  std::vector<TemplatePoint> template_points_;  // where names are kept
};

}  // namespace

FunctionFile parse_functions(std::string_view bytes) { return Parser(bytes).parse(); }

FunctionTemplate parse_template(std::string_view bytes) {
  FunctionTemplate names;
  Parser parser(bytes, &names);
  names.diagnostics = parser.parse().diagnostics;
  names.text = parser.text();
  return names;
}

}  // namespace nutik
