#include "system/linux_calls.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include "capture/format.hpp"

#if defined(__linux__) && !defined(NUTIK_POSIX)
#define NUTIK_LINUX 1
#else
#define NUTIK_LINUX 0
#endif

namespace nutik {
namespace {

void read_target(int folder, const char* name, Link& link) {
  std::array<char, 4096> target{};
  const ssize_t length = readlinkat(folder, name, target.data(), target.size());
  if (length < 0) {
    link.error = errno;
  } else {
    link.target = std::string(target.data(), static_cast<std::size_t>(length));
  }
}

}  // namespace

#if NUTIK_LINUX

int open_nameless(const std::filesystem::path& folder, int access, mode_t mode) {
  return open(folder.c_str(), O_TMPFILE | access | O_CLOEXEC, mode);
}

bool give_name(int descriptor, const std::filesystem::path& path) {
  return linkat(AT_FDCWD, path_of(descriptor).c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

std::filesystem::path path_of(int descriptor) { return format("/proc/self/fd/{}", descriptor); }

int open_folder(const std::filesystem::path& folder) {
  return open(folder.c_str(), O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

std::filesystem::path path_in(int opened, const std::filesystem::path&, const std::string& name) {
  return path_of(opened) / name;
}

Link read_link(const std::filesystem::path& path) {
  Link link;
  // The link itself, so that nobody can put another in its place meanwhile.
  const int descriptor = open(path.c_str(), O_PATH | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor < 0 || fstat(descriptor, &link.status) != 0) {
    link.error = errno;
  } else if (S_ISLNK(link.status.st_mode)) {
    read_target(descriptor, "", link);
  }
  if (descriptor >= 0) close(descriptor);
  return link;
}

bool is_running_program(const std::filesystem::path& name) {
  return !name.has_parent_path() || name == program_invocation_name;
}

std::filesystem::path running_program(const std::filesystem::path&) {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error);
}

#else

int open_nameless(const std::filesystem::path&, int, mode_t) { return -1; }

bool give_name(int, const std::filesystem::path&) {
  errno = ENOTSUP;  // there is none to be named
  return false;
}

std::filesystem::path path_of(int descriptor) { return format("/dev/fd/{}", descriptor); }

int open_folder(const std::filesystem::path& folder) {
  return open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

std::filesystem::path path_in(int, const std::filesystem::path& folder, const std::string& name) {
  return folder / name;
}

Link read_link(const std::filesystem::path& path) {
  Link link;
  if (lstat(path.c_str(), &link.status) != 0) {
    link.error = errno;
  } else if (S_ISLNK(link.status.st_mode)) {
    read_target(AT_FDCWD, path.c_str(), link);
  }
  return link;
}

bool is_running_program(const std::filesystem::path& name) { return !name.has_parent_path(); }

// As the shell found it.
std::filesystem::path running_program(const std::filesystem::path& name) {
  const char* const folders = std::getenv("PATH");
  std::istringstream in(folders == nullptr ? "" : folders);
  for (std::string folder; std::getline(in, folder, ':');) {
    const std::filesystem::path file = std::filesystem::path(folder) / name;
    std::error_code error;
    if (access(file.c_str(), X_OK) == 0) return std::filesystem::canonical(file, error);
  }
  return {};
}

#endif

void* grow_mapping(void* pages, std::uint64_t from, std::uint64_t to) {
#if NUTIK_LINUX && !defined(__SANITIZE_THREAD__)  // which does not see pages move, and takes what was there for a race
  return mremap(pages, from, to, MREMAP_MAYMOVE);
#else
  void* const larger = mmap(nullptr, to, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (larger == MAP_FAILED) return larger;
  std::memcpy(larger, pages, from);
  munmap(pages, from);
  return larger;
#endif
}

void prefer_huge_pages([[maybe_unused]] void* pages, [[maybe_unused]] std::uint64_t bytes) {
#if NUTIK_LINUX
  madvise(pages, bytes, MADV_HUGEPAGE);
#endif
}

}  // namespace nutik
