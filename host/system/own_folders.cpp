#include "system/own_folders.hpp"

#include <dlfcn.h>

#include <cstdlib>

#include "system/is_absent.hpp"
#include "system/linux_calls.hpp"

#ifndef NUTIK_INSTALLED_MODULES
#error "NUTIK_INSTALLED_MODULES is not set: the folder of installed modules, relative to the program's"
#endif

namespace nutik {
namespace {

// The file that this code was linked into: a program, or a library that another program has loaded.
std::vector<std::filesystem::path> own_files() {
  Dl_info info{};
  std::error_code error;
  if (dladdr(reinterpret_cast<const void*>(&own_files), &info) == 0 || info.dli_fname == nullptr) return {};
  // A program is named as it was called, by a name in PATH or by any other, which another file here may have. Where a
  // dynamic loader was called with it, the running program is that.
  const std::filesystem::path named = info.dli_fname;
  std::vector<std::filesystem::path> files;
  if (is_running_program(named)) files.push_back(running_program(named));
  if (named.has_parent_path()) files.push_back(std::filesystem::canonical(named, error));
  if (files.front() == files.back()) files.resize(1);
  std::erase(files, std::filesystem::path());
  return files;
}

}  // namespace

std::vector<std::filesystem::path> own_folders() {
  std::vector<std::filesystem::path> folders;
  for (const std::filesystem::path& own : own_files()) {
    folders.push_back(own.parent_path());
    folders.push_back(own.parent_path() / NUTIK_INSTALLED_MODULES);
  }
  return folders;
}

void use_own_fonts() {
  if (!is_absent("/etc/fonts/fonts.conf")) return;
  for (const std::filesystem::path& folder : own_folders()) {
    const std::filesystem::path file = folder / "fonts" / "fonts.conf";
    if (!is_absent(file)) ::setenv("FONTCONFIG_FILE", file.c_str(), 0);
  }
}

}  // namespace nutik
