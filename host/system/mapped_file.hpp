// A file's bytes, mapped into memory read-only.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace nutik {

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
};

// The first 16 bytes of a regular file, or all it has; of anything else (a pipe would never end), none.
[[nodiscard]] std::string first_bytes(const std::filesystem::path& path);

}  // namespace nutik
