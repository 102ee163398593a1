#include "system/temporary_folder.hpp"

#include <cstdlib>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {

std::filesystem::path temporary_folder() {
  const char* stated = std::getenv("TMPDIR");
  std::filesystem::path folder = stated != nullptr && *stated != '\0' ? stated : "/tmp";
  std::error_code reason;
  if (std::filesystem::is_directory(folder, reason)) return folder;
  throw OutputError(
      format("there is no folder {} for temporary files; let TMPDIR name one with room", folder.string()));
}

}  // namespace nutik
