// Warnings of many exposures, each said once for all that it holds for.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>

namespace nutik::app {

class SharedWarnings {
 public:
  // What is to be said of one exposure, which a person knows by `label`.
  void add(const std::string& label, std::span<const std::string> warnings);

  // `LABEL: warning`, or `LABEL and 3 more: warning` with the first one's label.
  void print() const;

 private:
  struct Exposures {
    std::string first;
    std::uint64_t count = 0;
  };
  std::map<std::string, Exposures> warnings_;
};

}  // namespace nutik::app
