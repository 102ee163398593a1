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
std::filesystem::path own_file() {
  Dl_info info{};
  std::error_code error;
  if (dladdr(reinterpret_cast<const void*>(&own_file), &info) == 0 || info.dli_fname == nullptr) return {};
  // A program is named as it was called, which may be by a name in PATH: a file of that name here is another.
  const std::filesystem::path named = info.dli_fname;
  return named.has_parent_path() ? std::filesystem::canonical(named, error) : running_program(named);
}

}  // namespace

std::vector<std::filesystem::path> own_folders() {
  const std::filesystem::path own = own_file();
  if (own.empty()) return {};
  return {own.parent_path(), own.parent_path() / NUTIK_INSTALLED_MODULES};
}

void use_own_fonts() {
  if (!is_absent("/etc/fonts/fonts.conf")) return;
  for (const std::filesystem::path& folder : own_folders()) {
    const std::filesystem::path file = folder / "fonts" / "fonts.conf";
    if (!is_absent(file)) ::setenv("FONTCONFIG_FILE", file.c_str(), 0);
  }
}

}  // namespace nutik
