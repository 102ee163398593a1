#include "system/output_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code ignored;
  if (std::filesystem::is_symlink(path_, ignored)) {
    path_ = std::filesystem::weakly_canonical(path_, ignored);  // what it points to is replaced, not it
  }
  if (std::filesystem::exists(path_, ignored) && !std::filesystem::is_regular_file(path_, ignored)) {
    throw OutputError(format("{} exists and is no regular file; choose another name", path_.string()));
  }
  // Never through what stands there already, be it another's link in a folder that all may write to.
  constexpr int kMostTries = 100;
  for (int tried = 0; descriptor_ < 0 && tried < kMostTries; ++tried) {
    const std::string again = tried == 0 ? "" : format("-{}", tried);
    temporary_path_ =
        path_.parent_path() / format(".{}.{}{}.part", path_.filename().string(), getpid(), again);
    descriptor_ = open(temporary_path_.c_str(), O_CREAT | O_EXCL | O_NOFOLLOW | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != EEXIST) break;
  }
  if (descriptor_ < 0) fail("cannot be created");
}

OutputFile::~OutputFile() {
  if (descriptor_ < 0) return;
  close(descriptor_);
  unlink(temporary_path_.c_str());
}

void OutputFile::fail(const char* what) const {
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
  const int descriptor = descriptor_;
  descriptor_ = -1;
  if (close(descriptor) != 0 || rename(temporary_path_.c_str(), path_.c_str()) != 0) {
    const int reason = errno;
    unlink(temporary_path_.c_str());
    errno = reason;
    fail("cannot be written");
  }
}

void write_text(const std::filesystem::path& path, std::string_view text) {
  OutputFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace nutik
