#include "opencl/cache_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <system_error>

#include "capture/format.hpp"

namespace nutik {
namespace {

constexpr mode_t kOthersMayWrite = S_IWGRP | S_IWOTH;

// What lies there is no kernel of ours: those take 0.3 MB.
constexpr off_t kLargestFile = off_t{64} << 20;

// PoCL's compiler ends the process where it finds no room. Our kernels take 0.5 MB of it.
constexpr std::uint64_t kRoomForPocl = 8ull << 20;
constexpr const char* kPoclVariable = "POCL_CACHE_DIR";

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

// Who else could put code into a folder, and the way out.
struct Others {
  std::string text, way_out;
};
Others others_in(const std::filesystem::path& folder) {
  struct stat status {};
  if (folder.empty() || stat(folder.c_str(), &status) != 0) return {};
  struct stat link {};  // or the folder itself
  if (status.st_uid != geteuid() || (lstat(folder.c_str(), &link) == 0 && link.st_uid != geteuid())) {
    return {format("{} belongs to another user, who could put code of their own there", folder.string()),
            "move it away, or set XDG_CACHE_HOME"};
  }
  if ((status.st_mode & kOthersMayWrite) != 0) {
    return {format("other users may write to {} and put code of their own there", folder.string()),
            "remove it, and it is made again for you alone"};
  }
  return {};
}

// In the folder, or where it would be made.
bool has_room(std::filesystem::path folder) {
  struct statvfs disk {};
  while (statvfs(folder.c_str(), &disk) != 0) {
    if (errno != ENOENT || folder == folder.parent_path()) return true;  // nothing is known
    folder = folder.parent_path();
  }
  return std::uint64_t{disk.f_bavail} * disk.f_frsize >= kRoomForPocl;
}
std::string no_room(const std::filesystem::path& folder) {
  return format("there are not {} MB of room for {}", kRoomForPocl >> 20, folder.string());
}

// A folder, or the nearest above it that is there, if it cannot be written to.
std::filesystem::path unwritable(std::filesystem::path folder) {
  while (faccessat(AT_FDCWD, folder.c_str(), W_OK, AT_EACCESS) != 0) {
    if (errno != ENOENT || folder == folder.parent_path()) return folder;
    folder = folder.parent_path();
  }
  return {};
}

// Why PoCL is not to keep what it builds in a folder, which it makes if need be.
std::string flaw_for_pocl(const std::filesystem::path& folder) {
  for (const std::filesystem::path& each : {folder.parent_path(), folder}) {
    if (const Others others = others_in(each); !others.text.empty()) return others.text;
  }
  if (const auto at = unwritable(folder); !at.empty()) return format("{} cannot be written to", at.string());
  return has_room(folder) ? "" : no_room(folder);
}

// For PoCL where its usual one will not do.
std::filesystem::path own_cache_of_pocl() {
  const std::filesystem::path stated = stated_folder("TMPDIR");
  return (stated.empty() ? "/tmp" : stated) / format("nutik-pocl-{}", geteuid()) / "kcache";
}

}  // namespace

std::filesystem::path default_cache_folder() {
  if (const auto folder = stated_folder("XDG_CACHE_HOME"); !folder.empty()) return folder / "nutik-cl";
  if (const auto home = stated_folder("HOME"); !home.empty()) return home / ".cache" / "nutik-cl";
  return {};
}

std::string flaw_of_cache(const std::filesystem::path& folder) {
  const Others others = others_in(folder);
  if (others.text.empty()) return {};
  return format("built kernels are not kept: {}; {}", others.text, others.way_out);
}

bool can_be_kept_in(const std::filesystem::path& folder) { return !folder.empty() && unwritable(folder).empty(); }

void choose_cache_of_pocl() {
  // PoCL ends the program where it is empty.
  if (const char* const stated = std::getenv(kPoclVariable); stated != nullptr && *stated != '\0') return;
  ::unsetenv(kPoclVariable);
  const char* const caches = std::getenv("XDG_CACHE_HOME");
  const bool is_relative = caches != nullptr && *caches != '\0' && *caches != '/';
  const std::filesystem::path usual = default_cache_folder().parent_path();
  if (!is_relative && !usual.empty() && flaw_for_pocl(usual / "pocl" / "kcache").empty()) return;
  ::setenv(kPoclVariable, own_cache_of_pocl().c_str(), 0);
}

std::filesystem::path cache_of_pocl() {
  const char* const stated = std::getenv(kPoclVariable);
  return stated == nullptr ? default_cache_folder().parent_path() / "pocl" / "kcache" : stated;
}

std::string flaw_of_pocl_cache() {
  const char* const stated = std::getenv(kPoclVariable);
  if (stated == nullptr) return {};  // the usual one
  const std::filesystem::path folder = stated;
  if (folder != own_cache_of_pocl()) return has_room(folder) ? "" : no_room(folder);
  // Made before they are looked at: nobody comes between.
  for (const std::filesystem::path& each : {folder.parent_path(), folder}) {
    if (mkdir(each.c_str(), S_IRWXU) != 0 && errno != EEXIST) return format("{} cannot be made", each.string());
  }
  return flaw_for_pocl(folder);
}

std::string read_from_cache(const std::filesystem::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0) return {};
  struct stat status {};
  std::string bytes;
  if (fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && is_ours_alone(status) &&
      status.st_size <= kLargestFile) {
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
  // Whatever the umask is: what others may write to is not read.
  chmod(unfinished.c_str(), S_IRUSR | S_IWUSR);
  if (out) std::filesystem::rename(unfinished, path, error);
  if (!out || error) std::filesystem::remove(unfinished, error);
}

}  // namespace nutik
