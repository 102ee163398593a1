// Lists: the first byte chooses between lines of a batch, which are command lines, and names of a sequence of stills,
// of which the first line is what a person names, and each other one a file that is there.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "app/command_line/command_line.hpp"
#include "fuzz/target.hpp"
#include "media/stills/still_sequence.hpp"
#include "session/text/shell_text.hpp"
#include "system/input_bytes.hpp"

namespace nutik::fuzz {
namespace {

constexpr std::size_t kMaxFiles = 12, kMaxName = 80;

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

void read_batch(Bytes input) {
  const std::string text = text_up_to(as_file(input, "list.txt").string(), input.size());
  demand(text == as_text(input), "a list is read whole");
  for (const std::string& line : lines_of(text)) {
    std::vector<std::string> words = shell_words(line);
    std::string again;
    for (const std::string& word : words) again += shell_word(word) + ' ';
    // What a terminal would obey is shown as a shell's command makes it, which lists do not run.
    const bool is_plain = again.find("$(printf '") == std::string::npos;
    demand(!is_plain || shell_words(again) == words, "words are read from what they are printed as");
    const auto prints = [](const std::string& word) {
      return word == "--help" || word == "-h" || word == "--version";
    };
    if (std::ranges::any_of(words, prints)) continue;
    words.insert(words.begin(), "expose");
    static_cast<void>(app::parse_command_line(words));
  }
}

// What has no folders, and is shown as it is.
std::string name_of(std::string line) {
  std::erase_if(line, [](char c) { return c == '/' || c == '\0'; });
  return line.substr(0, kMaxName);
}

void read_names(Bytes input) {
  const std::filesystem::path folder = as_file({}, "here").parent_path() / "sequence";
  std::filesystem::create_directory(folder);
  for (const auto& entry : std::filesystem::directory_iterator(folder)) std::filesystem::remove_all(entry);
  std::string pattern;
  std::size_t count = 0;
  for (const std::string& line : lines_of(as_text(input))) {
    if (count++ == 0) {
      pattern = name_of(line);
    } else if (const std::string name = name_of(line); !name.empty() && name != "." && name != "..") {
      as_file({}, std::string("sequence/") + name);
    }
    if (count > kMaxFiles) break;
  }
  const std::filesystem::path path = folder / pattern;
  demand(!sequence_name(path).empty(), "every sequence has a name");
  const auto files = list_stills(path);
  if (!files) return;
  demand(!files->empty(), "a sequence has files");
  for (const auto& file : *files) demand(std::filesystem::exists(file), "a sequence's files are there");
  static_cast<void>(missing_still_note(folder, *files));
}

void read(Bytes input) {
  if (input.empty()) return;
  (input.front() == std::byte{'n'} ? read_names : read_batch)(input.subspan(1));
}

}  // namespace

// Options are a few kilobytes for each line, and lines may be empty.
const Target kTarget{{1 << 22, 4000}, read};

}  // namespace nutik::fuzz
