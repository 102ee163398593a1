#include "exposure/function_diagnostics.hpp"

#include <algorithm>
#include <utility>

#include "capture/format.hpp"

namespace nutik {

std::string Diagnostic::text(std::string_view file_name) const {
  const std::string_view kind = severity == Severity::warning ? "warning: " : "";
  const std::string first = format("{}:{}:{}: {}{}", file_name, place.line, place.column, kind, message);
  // An empty line shows nothing, nor does one of no text.
  if (excerpt.text.empty() || excerpt.text.find("\\x00") != std::string::npos) return first;
  return format("{}\n    {}\n    {}^", first, excerpt.text, excerpt.indent);
}

void Diagnostics::add(Diagnostic::Severity severity, const SourceText& source, std::size_t at,
                      std::string message) {
  std::size_t& count = counts_[static_cast<std::size_t>(severity)];
  ++count;
  const TextPlace place = source.place_of(at);
  const auto is_alike = [&](const Diagnostic& diagnostic) { return diagnostic.severity == severity; };
  if (count > kMaxShown) {
    // A mistake may be found after those behind it: an open brace at the end of the file.
    const auto last = std::find_if(shown_.rbegin(), shown_.rend(), is_alike);
    if (place >= last->place) return;
    shown_.erase(std::next(last).base());
  }
  const auto behind = [](const TextPlace& a, const Diagnostic& b) { return a < b.place; };
  shown_.insert(std::upper_bound(shown_.begin(), shown_.end(), place, behind),
                {severity, place, std::move(message), source.excerpt(at)});
}

std::string Diagnostics::report(std::string_view file_name) const {
  std::string text;
  const auto append = [&](const std::string& line) {
    if (!text.empty()) text.push_back('\n');
    text += line;
  };
  for (const Diagnostic& diagnostic : shown_) append(diagnostic.text(file_name));
  const auto append_more = [&](Diagnostic::Severity severity, std::string_view name) {
    if (count(severity) <= kMaxShown) return;
    const std::size_t more = count(severity) - kMaxShown;
    append(format("{}: and {} more {}{}", file_name, more, name, more == 1 ? "" : "s"));
  };
  append_more(Diagnostic::Severity::error, "mistake");
  append_more(Diagnostic::Severity::warning, "warning");
  return text;
}

}  // namespace nutik
