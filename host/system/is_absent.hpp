// Whether nothing stands under a name.
#pragma once

#include <filesystem>
#include <system_error>

namespace nutik {

// Only where the system says so (ENOENT, ENOTDIR). What cannot be looked at, in a folder of others or on a disk that
// fails, may be there: std::filesystem::exists() calls it absent, and it would be replaced, or another taken for it.
[[nodiscard]] inline bool is_absent(const std::filesystem::path& path) {
  std::error_code reason;
  return std::filesystem::status(path, reason).type() == std::filesystem::file_type::not_found;
}

}  // namespace nutik
