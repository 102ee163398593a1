#include "app/command_line/help_text.hpp"

#include <algorithm>

namespace nutik::app {

std::string brief(std::string_view summary) {
  std::string sentence(summary.substr(0, summary.find(". ")));
  sentence.erase(std::min(sentence.find(": "), sentence.size()));
  if (!sentence.ends_with('.')) sentence += '.';
  return sentence;
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const auto end = text.find('\n');
    lines.push_back(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
  }
  return lines;
}

}  // namespace nutik::app
