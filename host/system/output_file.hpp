// An output file that appears whole or not at all: written without a name, or under a temporary one beside its own, it
// replaces what was there once everything has been written.
#pragma once

#include <sys/stat.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "system/mapped_file.hpp"

namespace nutik {

// What a signal handler knows of a temporary file.
struct KnownTemporary;

// Whether a lasting file of this process got its name. What it was made of was looked at right before.
[[nodiscard]] bool has_kept_output();

// What a name leads to, by links or none, and where nothing is there yet, too: two names of one file have the same.
[[nodiscard]] std::filesystem::path led_to(std::filesystem::path name);

// Throws OutputError where the folder of this output is absent or takes no new files, so that nobody works in vain.
void check_folder_of(const std::filesystem::path& output);

// The next output of this name replaces what is there now, and nothing that is put there or written to by then.
void expect_as_it_is(const std::filesystem::path& output);
// Outputs of any name replace whatever is there, as long as nothing else is said: for who begins another work.
void expect_anything();

// Removes the temporary files of this process. May be called in a signal handler, if the process then ends.
void remove_temporary_files();

class OutputFile {
 public:
  // Whether a file gets a name, or is one without (system/temporary_folder.hpp), to which `path` leads and which is
  // written where it lies. `recoverable`, of captures and videos: it has a temporary name while it is written, under
  // which a process that is killed leaves it.
  enum class Lasting { yes, recoverable, no };
  using Expected = std::optional<struct stat>;  // none: nothing

  // Creates the temporary file. It has no name until it is whole (O_TMPFILE) unless it is to be recoverable or the file
  // system has no such files; then, or for the moment of commit(), it is `.<name>.nutik-<16 random digits>.part`, with
  // only the beginning of a name that has no room for this. No file that is there is opened, so none can be lost,
  // whatever it is called. A link's target is written, whether there is one or not, unless the link is another user's
  // in a folder that all may write to. Throws OutputError where the folder is absent or not writable, or where it
  // cannot be told what stands under `path`.
  explicit OutputFile(std::filesystem::path path, Lasting lasting = Lasting::yes);
  // Removes the temporary file unless commit() was called.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  // Where to write for a library that opens files itself.
  [[nodiscard]] const std::filesystem::path& temporary_path() const { return temporary_path_; }

  // From now on called whenever something is written: what it throws ends the work.
  void check_by(std::function<void()> check) { check_ = std::move(check); }
  // For who writes to temporary_path().
  void check() const {
    if (check_) check_();
  }

  // Appends; throws OutputError with the system's reason (disk full, …).
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  [[nodiscard]] std::uint64_t size() const { return size_; }

  // Replaces what was written at `offset`, as many bytes.
  void replace(std::uint64_t offset, std::span<const std::byte> bytes);

  // Gives the file its name, once it has reached the disk, and the mode of what it replaces, without set-id bits.
  // Throws OutputError where expect_as_it_is() was said and it is not: this file stays beside it under its temporary
  // name, which the message tells. Throws InputError where a file that is mapped was lost since this began, or, in a
  // process that does one work, since that did (system/mapped_file.hpp).
  void commit();

  // Sends what was written to standard output, and leaves no file behind. Throws as commit() does.
  void send_to_standard_output();

  // Throws OutputError with the system's reason, which errno has: also for who writes to temporary_path().
  [[noreturn]] void fail(const char* what = "cannot be written") const;

 private:
  void take_free_name();
  void take_name_beside();
  [[noreturn]] void stay_beside();
  void keep_name() const;

  std::filesystem::path path_;
  std::filesystem::path temporary_path_;
  Lasting lasting_;
  std::function<void()> check_;
  std::optional<std::uint32_t> replaced_mode_;
  std::optional<Expected> expected_;
  MappedLosses losses_before_ = losses_so_far();
  KnownTemporary* known_ = nullptr;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

// A file of this text.
void write_text(const std::filesystem::path& path, std::string_view text);

// The same under a name without folders that somebody else chose, in a folder that is made if need be. Throws
// OutputError where something of that name is there, also a link, and where the folder is a link or not this user's:
// files that came from others may lead elsewhere.
void write_new_text(const std::filesystem::path& folder, const std::string& name, std::string_view text);

}  // namespace nutik
