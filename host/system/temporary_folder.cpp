#include "system/temporary_folder.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "system/linux_calls.hpp"

namespace nutik {

std::filesystem::path temporary_folder() {
  const char* stated = std::getenv("TMPDIR");
  std::filesystem::path folder = stated != nullptr && *stated != '\0' ? stated : "/tmp";
  std::error_code reason;
  if (std::filesystem::is_directory(folder, reason)) return folder;
  throw OutputError(
      format("there is no folder {} for temporary files; let TMPDIR name one with room", folder.string()));
}

NamelessFile::NamelessFile() {
  const std::filesystem::path folder = temporary_folder();
  descriptor_ = open_nameless(folder, O_RDWR, 0600);
  if (descriptor_ >= 0) return;
  // Not every file system knows such files. There it has a name for a moment.
  std::string name = folder / "nutik-XXXXXX";
  descriptor_ = mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0) {
    throw OutputError(
        format("no temporary file can be made in {}: {}", folder.string(), std::strerror(errno)));
  }
  unlink(name.c_str());
}

NamelessFile::~NamelessFile() { close(descriptor_); }

std::filesystem::path NamelessFile::path() const { return path_of(descriptor_); }

}  // namespace nutik
