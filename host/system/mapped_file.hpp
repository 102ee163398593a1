// A file's bytes, mapped into memory read-only.
//
// What is mapped may be lost while it is looked at: a file that somebody makes shorter, a disk that fails. The system
// then ends the process (SIGBUS) unless an application has asked for something else, with watch_mapped_files().
//
//   always:  what was made of a file that was lost or written to meanwhile is not used: check_mapped_files() throws
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace nutik {

// What is known of a mapping, also to a signal handler.
struct WatchedMapping;

class MappedFile {
 public:
  // Throws InputError naming the file: absent, a folder, not readable.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&&) = delete;

  // Starts on a page border.
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

  // Tells the system that `part` of bytes() will not be read again soon: it no longer counts as this
  // process's memory, and comes back when it is read after all.
  void release(std::span<const std::byte> part) const;

 private:
  std::span<const std::byte> bytes_;
  WatchedMapping* watched_ = nullptr;
};

// From now on bytes of mapped files that cannot be read are zeros, on every thread, those of a device's driver
// included. A program that does this calls check_mapped_files() before it says that all went well. Other libraries' SIGBUS ends the
// program as before.
void watch_mapped_files();

// Throws InputError naming a file that was lost, made shorter or written to while it was mapped, from then on whenever
// it is called. Nothing gets its name (system/output_file.hpp) without this having been called.
void check_mapped_files();

// The first 16 bytes of a regular file, or all it has; of anything else (a pipe would never end), none.
[[nodiscard]] std::string first_bytes(const std::filesystem::path& path);

}  // namespace nutik
