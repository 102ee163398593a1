#include "app/commands/findings.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "capture/format.hpp"
#include "features/schema/option.hpp"
#include "session/text/number_text.hpp"

namespace nutik::app {
namespace {

using Severity = Finding::Severity;

constexpr std::size_t kMaxOfAKind = 20;

std::string text_of(const Finding& finding) {
  if (finding.place) {
    return Diagnostic{finding.severity, *finding.place, finding.message, finding.excerpt}.text(finding.file);
  }
  return format("{}: {}{}{}", finding.file, finding.severity == Severity::warning ? "warning: " : "",
                finding.message, written(finding.settings, Dialect::command_line));
}

Json details_json(const std::vector<BlendedValue>& blended) {
  Json values = Json::array();
  for (const BlendedValue& value : blended) {
    values.push_back(
        {{"mask_value", value.value}, {"pixels", value.pixel_count}, {"x", value.x}, {"y", value.y}});
  }
  return Json{{"values", values}};
}

Json details_json(const std::vector<MaskSpeck>& specks) {
  Json places = Json::array();
  for (const MaskSpeck& speck : specks) {
    places.push_back({{"x", speck.x}, {"y", speck.y}, {"pixels", speck.pixel_count}});
  }
  return Json{{"mask_value", specks.front().tag}, {"specks", places}};
}

Json details_json(std::uint8_t tag) { return Json{{"mask_value", tag}}; }
Json details_json(std::monostate) { return Json::object(); }

Json json_of(const Finding& finding) {
  Json json{{"severity", finding.severity == Severity::warning ? "warning" : "error"},
            {"kind", finding.kind},
            {"file", finding.file},
            {"message", finding.message + written(finding.settings, Dialect::command_line)}};
  if (finding.place) {
    json["line"] = finding.place->line;
    json["column"] = finding.place->column;
  }
  json.update(std::visit([](const auto& details) { return details_json(details); }, finding.details));
  return json;
}

}  // namespace

std::size_t count_of(const std::vector<Finding>& findings, Finding::Severity severity) {
  return static_cast<std::size_t>(std::ranges::count(findings, severity, &Finding::severity));
}

std::string findings_text(const std::vector<Finding>& findings) {
  std::string text;
  std::map<std::pair<std::string, std::string>, std::size_t> counts;
  for (const Finding& finding : findings) {
    if (++counts[{finding.file, finding.kind}] > kMaxOfAKind) continue;
    text += (text.empty() ? "" : "\n") + text_of(finding);
  }
  for (const auto& [of, count] : counts) {
    if (count <= kMaxOfAKind) continue;
    text += format("\n{}: and {} more like these ({}); --json lists all", of.first, count - kMaxOfAKind,
                   of.second);
  }
  return text;
}

Json findings_json(const std::vector<Finding>& findings) {
  Json json = Json::array();
  for (const Finding& finding : findings) json.push_back(json_of(finding));
  return json;
}

std::string verdict(const std::vector<Finding>& findings) {
  const std::size_t mistakes = count_of(findings, Finding::Severity::error);
  const std::size_t warnings = count_of(findings, Finding::Severity::warning);
  if (mistakes == 0 && warnings == 0) return "nothing wrong";
  if (mistakes == 0) return counted(warnings, "warning");
  if (warnings == 0) return counted(mistakes, "mistake");
  return counted(mistakes, "mistake") + ", " + counted(warnings, "warning");
}

}  // namespace nutik::app
