// What is written of a camera's path beside a capture.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/output/report.hpp"
#include "features/schema/options.hpp"
#include "session/clips/clip_source.hpp"

namespace nutik::app {

class CameraFiles {
 public:
  // Throws UsageError where one of them may not be written.
  CameraFiles(const Options& options, const std::filesystem::path& capture, std::vector<std::string> inputs);

  // Writes what was asked for, and adds the path to an answer.
  void write(const CameraPath& path, const Timeline& timeline, const std::string& heading,
             Answer& answer) const;

 private:
  std::optional<std::string> folder_, table_, plot_, coverage_;
};

}  // namespace nutik::app
