#include "app/output/shared_warnings.hpp"

#include "app/output/console.hpp"
#include "session/format.hpp"

namespace nutik::app {

void SharedWarnings::add(const std::string& label, std::span<const std::string> warnings) {
  for (const std::string& warning : warnings) {
    Exposures& exposures = warnings_.try_emplace(warning, Exposures{label, 0}).first->second;
    ++exposures.count;
  }
}

void SharedWarnings::print() const {
  for (const auto& [warning, exposures] : warnings_) {
    const std::string others = exposures.count > 1 ? format(" and {} more", exposures.count - 1) : "";
    print_warning(format("{}{}: {}", exposures.first, others, warning));
  }
}

}  // namespace nutik::app
