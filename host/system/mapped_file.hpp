// A file's bytes, mapped into memory read-only.
//
// What is mapped may be lost while it is looked at: a file that somebody makes shorter, a disk that fails. The system
// then ends the process (SIGBUS) unless an application has asked for something else, with watch_mapped_files().
//
//   always:  what was made of a file that was lost or written to meanwhile is not used: check() and
//            check_mapped_files() throw. What has nothing to do with that file goes on, and so does the file once it is
//            opened again
#pragma once

#include <cstddef>
#include <cstdint>
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

  // Throws InputError where it was lost, made shorter or written to since it was mapped.
  void check() const;

  // Tells the system that `part` of bytes() will not be read again soon: it no longer counts as this
  // process's memory, and comes back when it is read after all.
  void release(std::span<const std::byte> part) const;

 private:
  std::span<const std::byte> bytes_;
  WatchedMapping* watched_ = nullptr;
};

// From now on bytes of mapped files that cannot be read are zeros, on every thread, those of a device's driver
// included. A program that does this asks check() or check_mapped_files() before it says that all went well. A SIGBUS
// of anything else goes where it went before.
void watch_mapped_files();
// Puts this handler and those of catch_limits() back, if an application asked for them: a library may have taken their
// places, as LLVM does when a driver compiles. LLVM's handlers pass over a first SIGXCPU, and step aside at the first
// SIGBUS: a second thread's, a moment later, would end the process.
void take_back_signals();

// How many files were lost, made shorter or written to while they were mapped.
struct MappedLosses {
  std::uint64_t count = 0;
};

// This process does one work: all that it reads is of that work, from its start to its end.
void do_one_work();
// What a work that begins now has nothing to do with. None in a process that does one.
[[nodiscard]] MappedLosses losses_so_far();

// Throws InputError naming a file that was lost since. Nothing gets its name (system/output_file.hpp) without this
// having been called.
void check_mapped_files(MappedLosses before = {});

// The first 16 bytes of a regular file, or all it has; of anything else (a pipe would never end), none.
[[nodiscard]] std::string first_bytes(const std::filesystem::path& path);

}  // namespace nutik
