#include "app/text/findings.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "session/format.hpp"
#include "session/size_text.hpp"

namespace nutik::app {
namespace {

constexpr std::size_t kMostOfAKind = 20;

}  // namespace

std::string Finding::text() const {
  if (place) return Diagnostic{severity, *place, message, excerpt}.text(file);
  return format("{}: {}{}", file, severity == Severity::warning ? "warning: " : "", message);
}

Json Finding::json() const {
  Json json{{"severity", severity == Severity::warning ? "warning" : "error"},
            {"kind", kind},
            {"file", file},
            {"message", message}};
  if (place) {
    json["line"] = place->line;
    json["column"] = place->column;
  }
  json.update(details);
  return json;
}

std::size_t Findings::count(Finding::Severity severity) const {
  return static_cast<std::size_t>(std::ranges::count(findings_, severity, &Finding::severity));
}

std::string Findings::text() const {
  std::string text;
  std::map<std::pair<std::string, std::string>, std::size_t> counts;
  for (const Finding& finding : findings_) {
    if (++counts[{finding.file, finding.kind}] > kMostOfAKind) continue;
    text += (text.empty() ? "" : "\n") + finding.text();
  }
  for (const auto& [of, count] : counts) {
    if (count <= kMostOfAKind) continue;
    text += format("\n{}: and {} more like these ({}); --json lists all", of.first, count - kMostOfAKind,
                   of.second);
  }
  return text;
}

Json Findings::json() const {
  Json json = Json::array();
  for (const Finding& finding : findings_) json.push_back(finding.json());
  return json;
}

std::string Findings::verdict() const {
  const std::size_t mistakes = count(Finding::Severity::error);
  const std::size_t warnings = count(Finding::Severity::warning);
  if (mistakes == 0 && warnings == 0) return "nothing wrong";
  if (mistakes == 0) return counted(warnings, "warning");
  if (warnings == 0) return counted(mistakes, "mistake");
  return counted(mistakes, "mistake") + ", " + counted(warnings, "warning");
}

}  // namespace nutik::app
