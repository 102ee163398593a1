// Warnings of many exposures, each said once for all that it holds for.
//
//   threads: any number may add to one
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace nutik {

class SharedWarnings {
 public:
  // What is to be said of one exposure, which a person knows by `label`.
  void add(const std::string& label, std::span<const std::string> warnings);

  // `LABEL: warning`, or `LABEL and 3 more: warning` with the first one's label.
  [[nodiscard]] std::vector<std::string> lines() const;

 private:
  struct Exposures {
    std::string first, warning;
    std::uint64_t count = 0;
  };
  mutable std::mutex adding_;
  std::map<std::string, Exposures> warnings_;  // by their text but for its numbers
};

}  // namespace nutik
