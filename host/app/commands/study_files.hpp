// The files of a study: its picture, and beside it what that was made with, to be changed by hand.
//
//   always:  what was changed by hand since, or is of no study, is not replaced unless asked. The commands' text knows
//            the others by their checksums
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "session/output_check.hpp"

namespace nutik::app {

class StudyFiles {
 public:
  explicit StudyFiles(std::filesystem::path output);

  // A picture on standard output has nothing beside it.
  [[nodiscard]] bool is_alone() const { return is_alone_; }

  // Throws UsageError where a file is an input too, or may not be replaced.
  void check(std::span<const std::string> inputs, Replacing replacing) const;

  void write_functions(std::string_view text) const;
  // The last: it notes what the others hold.
  void write_commands(std::string_view text, bool has_regions) const;

  std::filesystem::path picture, mask, functions, commands;

 private:
  [[nodiscard]] std::filesystem::path beside(const char* extension) const;

  bool is_alone_;
};

}  // namespace nutik::app
