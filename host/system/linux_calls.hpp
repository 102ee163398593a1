// What only Linux does, and beside it what POSIX lets every system do: slower, or by a name that somebody else may
// change meanwhile. NUTIK_POSIX takes the latter on Linux, too.
#pragma once

#include <sys/stat.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace nutik {

// A file in `folder` without a name. Negative where the system or the folder's file system knows none.
[[nodiscard]] int open_nameless(const std::filesystem::path& folder, int access, mode_t mode);
// Names such a file. False, with errno, where it cannot.
[[nodiscard]] bool give_name(int descriptor, const std::filesystem::path& path);

// The path by which this process opens again what it has open. Some systems then go on where that was read to.
[[nodiscard]] std::filesystem::path path_of(int descriptor);

// A folder, not a link to one, only to ask whose it is and to write into it. Negative, with errno, where it cannot.
[[nodiscard]] int open_folder(const std::filesystem::path& folder);
// What is called `name` in a folder so opened; POSIX: in what is called `folder` by now.
[[nodiscard]] std::filesystem::path path_in(int opened, const std::filesystem::path& folder, const std::string& name);

struct Link {
  int error = 0;  // errno
  struct stat status {};
  std::optional<std::string> target;  // of a link
};
[[nodiscard]] Link read_link(const std::filesystem::path& path);

// Whether what was loaded as `name` is the running program, as far as that can be told.
[[nodiscard]] bool is_running_program(const std::filesystem::path& name);
// The file of the running program, which was called `name`. Empty where it cannot be told.
[[nodiscard]] std::filesystem::path running_program(const std::filesystem::path& name);

// A mapping of more bytes that begins as this one, which it replaces. MAP_FAILED where there is none; this one stays.
[[nodiscard]] void* grow_mapping(void* pages, std::uint64_t from, std::uint64_t to);
// A hint, which changes nothing but speed.
void prefer_huge_pages(void* pages, std::uint64_t bytes);

}  // namespace nutik
