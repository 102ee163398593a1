#include "opencl/cache_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <system_error>

#include "capture/format.hpp"

namespace nutik {
namespace {

constexpr mode_t kOthersMayWrite = S_IWGRP | S_IWOTH;

bool is_ours_alone(const struct stat& status) {
  return status.st_uid == geteuid() && (status.st_mode & kOthersMayWrite) == 0;
}

// What a variable of the environment names; empty where it is not set. A relative path is none (XDG Base Directory
// Specification): it would mean another folder, with native code of whoever put it there, wherever the program starts.
std::filesystem::path stated_folder(const char* variable) {
  const char* const stated = std::getenv(variable);
  std::filesystem::path folder = stated == nullptr ? "" : stated;
  return folder.is_absolute() ? folder : std::filesystem::path();
}

}  // namespace

std::filesystem::path default_cache_folder() {
  if (const auto folder = stated_folder("XDG_CACHE_HOME"); !folder.empty()) return folder / "nutik-cl";
  if (const auto home = stated_folder("HOME"); !home.empty()) return home / ".cache" / "nutik-cl";
  return {};
}

std::string flaw_of_cache(const std::filesystem::path& folder) {
  struct stat status {};
  if (folder.empty() || stat(folder.c_str(), &status) != 0) return {};
  if (status.st_uid != geteuid()) {
    return format(
        "built kernels are not kept: {} belongs to another user, who could put code of their own there; move "
        "it "
        "away, or set XDG_CACHE_HOME",
        folder.string());
  }
  if ((status.st_mode & kOthersMayWrite) != 0) {
    return format(
        "built kernels are not kept: other users may write to {} and put code of their own there; remove it, "
        "and it is made again for you alone",
        folder.string());
  }
  return {};
}

std::string read_from_cache(const std::filesystem::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0) return {};
  struct stat status {};
  std::string bytes;
  if (fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && is_ours_alone(status)) {
    bytes.resize(static_cast<std::size_t>(status.st_size));
    std::size_t filled = 0;
    while (filled < bytes.size()) {
      const ssize_t count = read(descriptor, bytes.data() + filled, bytes.size() - filled);
      if (count <= 0) break;
      filled += static_cast<std::size_t>(count);
    }
    bytes.resize(filled);
  }
  close(descriptor);
  return bytes;
}

void write_to_cache(const std::filesystem::path& path, std::string_view bytes) {
  static std::atomic<unsigned> files{0};  // devices that are alike build the same kernels at a time
  const std::filesystem::path unfinished = path.string() + format(".{}-{}", getpid(), ++files);
  std::error_code error;
  std::filesystem::create_directories(path.parent_path().parent_path(), error);
  mkdir(path.parent_path().c_str(), S_IRWXU);  // there already, or it is the file that cannot be written
  std::ofstream out(unfinished, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (out) std::filesystem::rename(unfinished, path, error);
  if (!out || error) std::filesystem::remove(unfinished, error);
}

}  // namespace nutik
