// The files of a study: its picture, and beside it what that was made with, to be changed by hand.
//
//   always:  what was changed by hand since, or is of no study, is not replaced unless asked. The commands' text knows
//            the others by their checksums, while a study is being written those of the study before as well: what a
//            process that was ended has left is replaced by the next
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "capture/picture.hpp"
#include "session/output_check.hpp"

namespace nutik::app {

class StudyFiles {
 public:
  explicit StudyFiles(std::filesystem::path output);

  // A picture on standard output has nothing beside it.
  [[nodiscard]] bool is_alone() const { return is_alone_; }

  // Throws UsageError where a file is an input too, or may not be replaced.
  void check(std::span<const std::string> inputs, Replacing replacing) const;

  // Mask and functions, which the commands' text knows before they are there.
  void write_regions(const Picture& regions, std::string_view light);
  // The last, once the picture is there.
  void write_commands(std::string_view text) const;

  std::filesystem::path picture, mask, functions, commands;

 private:
  [[nodiscard]] std::filesystem::path beside(const char* extension) const;

  bool is_alone_;
  std::vector<std::pair<std::string, std::string>> sums_;  // of mask and functions, by name
};

}  // namespace nutik::app
