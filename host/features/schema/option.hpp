// The schema of requests, a row for each option: what is stated is parsed with it, on the command line and in Python,
// and help, manual, completion, recipes and the advice of messages are written from it.
#pragma once

#include <exception>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "capture/error.hpp"
#include "features/schema/command_id.hpp"
#include "features/schema/options.hpp"

namespace nutik {

// What an option is about. Where it can, what holds for some options and not for others follows from it and is asked of
// the row, so that few lists of options stand elsewhere.
enum class Scope {
  decoding,   // what a clip's codes are
  timing,     // when its pictures were exposed
  encoding,   // what is kept of it
  exposure,   // what a picture is made of
  series,     // how many there are, and what each of them is of
  subject,    // what a command looks at or draws
  computing,  // by which device, how exactly, within which memory
  output,     // where and how results are written
  answer,     // what scripts read
};

// Headings that many commands share, in help; the last one's rows are needed for no picture.
inline constexpr std::string_view kSourceClip = "The source clip", kClipCodes = "What a clip's codes are",
                                  kEventRecording = "A recording of events", kMovingCamera = "A camera that moved",
                                  kComputing = "Computing", kOutputs = "Output", kSeldomNeeded = "Seldom needed";

struct Option;
// Sets the field of Options that a value is kept in. Throws UsageError naming `what` where the word makes no sense.
using Take = void (*)(Options& options, const Option& row, std::string_view what, const std::string& word);

// How options are written: `--shutter-angle`, or `shutter_angle=`.
enum class Dialect { command_line, python };

struct Option {
  char short_name = 0;  // 0: none
  std::string_view long_name = {};
  std::string_view value = {};  // as in help, a word for each that is needed; empty: a flag
  Scope scope = {};
  CommandSet commands = 0;
  // Null: the option may be given again and again, and what it says stands in Options::said alone.
  Take take = nullptr;
  std::string_view help = {};
  // The values it knows, with blanks between; one that ends with `:` goes on as a person likes, `gamma:2.2`. Empty:
  // told by `value`.
  std::string_view choice_list = {};
  std::optional<Setting> setting = {};  // that errors and notes know it as
  std::string_view python = {};         // its argument's name there, where that is not the long name
  std::string_view heading = {};        // in help; kSeldomNeeded: completion and short help leave it out
  std::string_view old_name = {};       // its long name in earlier versions: still read, never shown

  // `--fps`
  [[nodiscard]] std::string name() const { return "--" + std::string(long_name); }
  // `-f`, or `--fps` where it has no short name.
  [[nodiscard]] std::string display_name() const;
  // How many words its value takes.
  [[nodiscard]] std::size_t word_count() const;
  [[nodiscard]] bool is_flag() const { return value.empty(); }
  [[nodiscard]] bool is_called(std::string_view name) const {
    return name == long_name || (name == old_name && !name.empty());
  }
  [[nodiscard]] bool is_of(CommandId command) const { return (commands & bit(command)) != 0; }
  [[nodiscard]] std::vector<std::string> choices() const;
  [[nodiscard]] bool knows(std::string_view word) const;

  // `fn` where `value` is FILE.fn; empty where no kind of file is named.
  [[nodiscard]] std::string_view file_extension() const;
  // Whether a value is a file's name, and whether that is read: no output may replace it.
  [[nodiscard]] bool takes_file() const;
  [[nodiscard]] bool reads_file() const { return takes_file() && scope != Scope::output; }
  // Whether that may be `-`: functions and masks, which are not large.
  [[nodiscard]] bool reads_standard_input() const { return reads_file() && !file_extension().empty(); }

  // Whether it says how a clip is turned into a capture: nothing for a .tik, which is one.
  [[nodiscard]] bool describes_clip() const {
    return scope == Scope::decoding || scope == Scope::timing || scope == Scope::encoding;
  }
  // Whether another value makes another picture, or another sheet of pictures.
  [[nodiscard]] bool makes_picture() const { return describes_clip() || scope == Scope::exposure; }
  [[nodiscard]] bool makes_sheet() const { return makes_picture() || scope == Scope::series; }
  // Whether lines of a batch share it: they share the capture, the device and the answer.
  [[nodiscard]] bool is_shared_by_batch() const {
    return describes_clip() || scope == Scope::computing || scope == Scope::answer;
  }

  // What is stated for it; null where nothing is, and for flags and repeatable options.
  [[nodiscard]] const std::string* stated(const Options& options) const;
  // Whether a flag is set, or a value stated; by the row of another command, too, that sets the same field.
  [[nodiscard]] bool is_in(const Options& options) const;
  // States it, by the name that messages have for it. Throws UsageError where it is stated already, and what take()
  // does.
  void state(Options& options, std::string_view what, std::vector<std::string> words) const;
  // The same in place of what was stated.
  void restate(Options& options, std::vector<std::string> words) const;
  // `--fps`, `rate=`; with a value `--unseen hold`, `unseen='hold'`.
  [[nodiscard]] std::string written(Dialect dialect, std::string_view word = {}) const;
};

// Heading by heading, as help shows them.
[[nodiscard]] std::span<const Option> schema();
// By `--fps` or `-f` without its dashes; null where there is none. Several rows may share a name, for commands
// that mean different things by it: as many words belong to it in each.
[[nodiscard]] const Option* find_option(std::string_view long_name);
[[nodiscard]] const Option* find_option(char short_name);
// The row of that name for this command.
[[nodiscard]] const Option* option_of(CommandId command, std::string_view long_name);
// Those of a command.
[[nodiscard]] std::vector<const Option*> options_of(CommandId command);

// That of a Python argument.
[[nodiscard]] const Option* option_of_argument(CommandId command, std::string_view name);

// What was said, without the options of a scope.
[[nodiscard]] Options without(const Options& options, Scope scope);

// `--crop`, `noise='auto'`
[[nodiscard]] std::string written(Setting setting, Dialect dialect);
// ` (--depth, --renderer)`: what settings are called; empty if there are none.
[[nodiscard]] std::string written(const std::vector<Setting>& settings, Dialect dialect);
// Advice (capture/error.hpp), with the options that stand in it between backquotes.
[[nodiscard]] std::string in_words(std::string_view advice, Dialect dialect);
// An error's message with its advice, a note with what would change it.
[[nodiscard]] std::string message_text(const std::exception& error, Dialect dialect);
[[nodiscard]] std::vector<std::string> note_texts(const std::vector<Note>& notes, Dialect dialect);

}  // namespace nutik
