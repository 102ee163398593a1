#include "app/command_line/help_text.hpp"

namespace nutik::app {

std::string brief(std::string_view summary) {
  for (const std::string_view end : {". ", " (default", ": "}) summary = summary.substr(0, summary.find(end));
  std::string sentence(summary);
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
