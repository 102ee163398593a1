#include "system/output_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "system/checksum.hpp"
#include "system/mapped_file.hpp"
#include "system/reused_entries.hpp"
#include "system/shared_state.hpp"

namespace nutik {

struct KnownTemporary {
  std::atomic<bool> is_there{false};
  bool is_free = false;  // guarded by `registering_temporaries`
  KnownTemporary* next = nullptr;
  std::array<char, 4096> path{};
};

namespace {

KnownTemporary* make_known(const std::string& path) {
  const std::scoped_lock lock(shared_state().registering_temporaries);
  KnownTemporary* const known = &reused_entry(shared_state().temporaries);
  if (path.size() < known->path.size()) {
    std::memcpy(known->path.data(), path.c_str(), path.size() + 1);
    known->is_there = true;
  }
  return known;
}

void make_unknown(KnownTemporary* known) {
  const std::scoped_lock lock(shared_state().registering_temporaries);
  known->is_there = false;
  known->is_free = true;
}

// What a link points to is written, not the link replaced; also where it points to nothing yet.
std::filesystem::path followed(std::filesystem::path path) {
  if (std::error_code ignored; !std::filesystem::is_symlink(path, ignored)) return path;
  std::error_code error;
  if (std::filesystem::exists(path, error)) {
    const std::filesystem::path target = std::filesystem::canonical(path, error);
    return error ? path : target;
  }
  for (int links = 0; std::filesystem::is_symlink(path, error); ++links) {
    constexpr int kMaxLinks = 40;  // as many as the system follows
    const std::filesystem::path target = std::filesystem::read_symlink(path, error);
    if (error || links == kMaxLinks) {
      throw OutputError(format("{} is a link that leads nowhere; choose another name", path.string()));
    }
    path = path.parent_path() / target;
  }
  return path;
}

// An open, locked, empty file of ours under this name; -1 and errno where there is none to be had. EEXIST: another
// process's, or another's altogether.
int open_temporary(const std::filesystem::path& path) {
  for (;;) {
    const int descriptor = open(path.c_str(), O_CREAT | O_NOFOLLOW | O_WRONLY | O_CLOEXEC | O_NONBLOCK, 0666);
    if (descriptor < 0) {
      const int reason = errno;
      struct stat there {};
      errno = lstat(path.c_str(), &there) == 0 ? EEXIST : reason;
      return -1;
    }
    const auto refuse = [&](int error) {
      close(descriptor);
      errno = error;
      return -1;
    };
    struct stat opened {};
    struct stat named {};
    if (fstat(descriptor, &opened) != 0) return refuse(errno);
    // Never through what somebody else put there, in a folder that all may write to.
    if (!S_ISREG(opened.st_mode) || opened.st_uid != geteuid() || opened.st_nlink > 1) return refuse(EEXIST);
    if (flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return refuse(EEXIST);
    // Its process may have given it its name before this one held the lock.
    if (lstat(path.c_str(), &named) == 0 && named.st_ino == opened.st_ino && named.st_dev == opened.st_dev) {
      if (ftruncate(descriptor, 0) == 0) return descriptor;
      const int reason = errno;
      unlink(path.c_str());
      return refuse(reason);
    }
    close(descriptor);
  }
}

// As many bytes of a name as a file system takes.
std::size_t longest_name(const std::filesystem::path& folder) {
  constexpr long kUsual = 255;
  const long stated = pathconf(folder.empty() ? "." : folder.c_str(), _PC_NAME_MAX);
  return static_cast<std::size_t>(stated > 0 ? stated : kUsual);
}

// A name's first bytes, and no half of a character: some file systems take none.
std::string_view beginning(std::string_view name, std::size_t bytes) {
  if (bytes >= name.size()) return name;
  const auto goes_on = [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U; };
  while (bytes > 0 && goes_on(name[bytes])) --bytes;
  return name.substr(0, bytes);
}

// Beside `path`. The same at every run, so that one run takes over what another left. Where the name has no room for
// more, its end gives way to a checksum of all of it: names that differ only there have temporary files of their own.
std::filesystem::path temporary_beside(const std::filesystem::path& path, int tried) {
  const std::string ending = tried == 0 ? ".nutik.part" : format(".nutik-{}.part", tried);
  const std::string name = path.filename().string();
  const std::size_t room = longest_name(path.parent_path());
  // What has no room at all is refused when it is created, not when all has been written.
  if (1 + name.size() + ending.size() <= room || name.size() > room) {
    return path.parent_path() / format(".{}{}", name, ending);
  }
  const std::string sum = format("-{:016x}", checksum(std::string_view(name)));
  const std::size_t taken = 1 + sum.size() + ending.size();
  return path.parent_path() /
         format(".{}{}{}", beginning(name, room > taken ? room - taken : 0), sum, ending);
}

}  // namespace

void remove_temporary_files() {
  for (const KnownTemporary* known = shared_state().temporaries.load(); known != nullptr;
       known = known->next) {
    if (known->is_there) unlink(known->path.data());
  }
}

bool has_kept_output() { return shared_state().has_kept_output; }

OutputFile::OutputFile(std::filesystem::path path, Lasting lasting)
    : path_(followed(std::move(path))), lasting_(lasting) {
  std::error_code ignored;
  if (std::filesystem::exists(path_, ignored) && !std::filesystem::is_regular_file(path_, ignored)) {
    throw OutputError(format("{} exists and is no regular file; choose another name", path_.string()));
  }
  constexpr int kMaxTries = 100;
  for (int tried = 0; descriptor_ < 0 && tried < kMaxTries; ++tried) {
    temporary_path_ = temporary_beside(path_, tried);
    descriptor_ = open_temporary(temporary_path_);
    if (descriptor_ < 0 && errno != EEXIST) break;
  }
  if (descriptor_ < 0) fail("cannot be created");
  known_ = make_known(temporary_path_.string());
}

OutputFile::~OutputFile() {
  if (descriptor_ < 0) return;
  unlink(temporary_path_.c_str());
  make_unknown(known_);
  close(descriptor_);  // and with it the lock
}

void OutputFile::fail(const char* what) const {
  const int reason = errno;
  check_mapped_files();  // what cannot be read cannot be written either
  errno = reason;
  throw OutputError(format("{} {}: {}", path_.string(), what, std::strerror(errno)));
}

void OutputFile::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      fail("cannot be written");
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    size_ += static_cast<std::uint64_t>(written);
  }
}

void OutputFile::write(std::span<const std::span<const std::byte>> parts) {
  std::array<iovec, 1024> vectors;  // as many as the system takes at once
  while (!parts.empty()) {
    const std::size_t count = std::min(parts.size(), vectors.size());
    for (std::size_t i = 0; i < count; ++i) {
      vectors[i] = {const_cast<std::byte*>(parts[i].data()), parts[i].size()};
    }
    ssize_t written = writev(descriptor_, vectors.data(), static_cast<int>(count));
    if (written < 0) {
      if (errno == EINTR) continue;
      fail("cannot be written");
    }
    size_ += static_cast<std::uint64_t>(written);
    while (!parts.empty() && static_cast<std::size_t>(written) >= parts.front().size()) {
      written -= static_cast<ssize_t>(parts.front().size());
      parts = parts.subspan(1);
    }
    if (written > 0) {  // the rest of a part of which a share was taken
      write(parts.front().subspan(static_cast<std::size_t>(written)));
      parts = parts.subspan(1);
    }
  }
}

void OutputFile::replace(std::uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0) {
      if (errno == EINTR) continue;
      fail("cannot be written");
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
}

void OutputFile::write(std::string_view text) { write(std::as_bytes(std::span(text))); }

void OutputFile::commit() {
  // A temporary file has the process's own permissions; what it replaces keeps its mode.
  struct stat before {};
  if (stat(path_.c_str(), &before) == 0) fchmod(descriptor_, before.st_mode & 07777);
  // Not every file system can; all that can fail to write say so here.
  if (lasting_ == Lasting::yes && fsync(descriptor_) != 0 && errno != EINVAL) fail("cannot be written");
  // All of it has been read and written by now. It is right, whatever becomes of what it was made of after this.
  check_mapped_files();
  if (rename(temporary_path_.c_str(), path_.c_str()) != 0) fail("cannot be written");
  if (lasting_ == Lasting::yes) shared_state().has_kept_output = true;
  make_unknown(known_);
  close(std::exchange(descriptor_, -1));
}

void OutputFile::send_to_standard_output() {
  check_mapped_files();
  const MappedFile written(temporary_path_);
  for (auto rest = written.bytes(); !rest.empty();) {
    const ssize_t sent = ::write(STDOUT_FILENO, rest.data(), rest.size());
    if (sent >= 0) {
      rest = rest.subspan(static_cast<std::size_t>(sent));
    } else if (errno != EINTR) {
      throw OutputError(format("standard output cannot be written: {}", std::strerror(errno)));
    }
  }
}

void write_text(const std::filesystem::path& path, std::string_view text) {
  OutputFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace nutik
