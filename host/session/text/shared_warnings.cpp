#include "session/text/shared_warnings.hpp"

#include <regex>
#include <set>

#include "capture/format.hpp"

namespace nutik {
namespace {

// What is said, whatever its figures are; that of `M0` is a name.
std::string shape_of(const std::string& warning) {
  static const std::regex figure("(^|[ (])[-+]?[0-9][0-9.]*(e[-+]?[0-9]+)?");
  return std::regex_replace(warning, figure, "$1#");
}

}  // namespace

void SharedWarnings::add(const std::string& label, std::span<const std::string> warnings) {
  const std::lock_guard lock(adding_);
  std::set<std::string> shapes;
  for (const std::string& warning : warnings) {
    const auto [shape, is_new] = shapes.insert(shape_of(warning));
    Exposures& exposures = warnings_.try_emplace(*shape, Exposures{label, warning, 0}).first->second;
    if (is_new) ++exposures.count;
  }
}

std::vector<std::string> SharedWarnings::lines() const {
  const std::lock_guard lock(adding_);
  std::vector<std::string> lines;
  for (const auto& [shape, exposures] : warnings_) {
    const std::string others = exposures.count > 1 ? format(" and {} more", exposures.count - 1) : "";
    lines.push_back(format("{}{}: {}", exposures.first, others, exposures.warning));
  }
  return lines;
}

}  // namespace nutik
