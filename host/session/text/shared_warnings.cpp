#include "session/text/shared_warnings.hpp"

#include "capture/format.hpp"

namespace nutik {

void SharedWarnings::add(const std::string& label, std::span<const std::string> warnings) {
  const std::lock_guard lock(adding_);
  for (const std::string& warning : warnings) {
    ++warnings_.try_emplace(warning, Exposures{label, 0}).first->second.count;
  }
}

std::vector<std::string> SharedWarnings::lines() const {
  const std::lock_guard lock(adding_);
  std::vector<std::string> lines;
  for (const auto& [warning, exposures] : warnings_) {
    const std::string others = exposures.count > 1 ? format(" and {} more", exposures.count - 1) : "";
    lines.push_back(format("{}{}: {}", exposures.first, others, warning));
  }
  return lines;
}

}  // namespace nutik
