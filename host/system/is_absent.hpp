// Whether nothing stands under a name, and what is thrown where a file was to be read there.
#pragma once

#include <filesystem>
#include <string>
#include <system_error>

#include "capture/error.hpp"

namespace nutik {

// Only where the system says so (ENOENT, ENOTDIR). What cannot be looked at, in a folder of others or on a disk that
// fails, may be there: std::filesystem::exists() calls it absent, and it would be replaced, or another taken for it.
[[nodiscard]] inline bool is_absent(const std::filesystem::path& path) {
  std::error_code reason;
  return std::filesystem::status(path, reason).type() == std::filesystem::file_type::not_found;
}

struct FileMissing : InputError {
  FileMissing(const std::filesystem::path& name, const std::string& message)
      : InputError(message), file(name.string()) {}

  std::string file;
};

}  // namespace nutik
