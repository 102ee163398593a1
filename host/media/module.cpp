#include "media/module.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "system/is_absent.hpp"

#ifndef NUTIK_INSTALLED_MODULES
#error "NUTIK_INSTALLED_MODULES is not set: the folder of installed modules, relative to the program's"
#endif
#ifndef NUTIK_VERSION
#error "NUTIK_VERSION is not set: modules of other versions have other tables of functions"
#endif

namespace nutik {
namespace {

// The file that this code was linked into: a program, or a library that another program has loaded.
std::filesystem::path own_file() {
  Dl_info info{};
  std::error_code error;
  if (dladdr(reinterpret_cast<const void*>(&own_file), &info) == 0 || info.dli_fname == nullptr) return {};
  const auto loaded = std::filesystem::canonical(info.dli_fname, error);
  if (!error) return loaded;
  // A program is named as it was called, which may be by a name in PATH.
  return std::filesystem::read_symlink("/proc/self/exe", error);
}

// Where modules may be, in the order of the search. An empty folder leaves it to the loader, which knows the run
// path that find_package(nutik) gives to whatever is linked to this library.
std::vector<std::filesystem::path> module_folders() {
  std::vector<std::filesystem::path> folders;
  if (const char* folder = std::getenv("NUTIK_MODULES"); folder != nullptr) folders.emplace_back(folder);
  if (const std::filesystem::path own = own_file(); !own.empty()) {
    folders.push_back(own.parent_path());
    folders.push_back(own.parent_path() / NUTIK_INSTALLED_MODULES);
  }
  folders.emplace_back();
  return folders;
}

}  // namespace

const void* load_module(const char* name, const char* symbol, const char* without) {
  std::string tried;
  for (const std::filesystem::path& folder : module_folders()) {
    const std::filesystem::path file = folder / name;
    if (!folder.empty() && is_absent(file)) {
      tried += format("\n  {}: no such file", file.string());
      continue;
    }
    // Never closed: OpenCV's and FFmpeg's threads may outlive any place where that would be safe. Lazily: what libraries
    // below a module call is looked up when they call it; what a module itself calls, now (-z now).
    void* library = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (library == nullptr) {
      tried += format("\n  {}", dlerror());  // which names the file
      continue;
    }
    const void* module = dlsym(library, symbol);
    const auto* version = static_cast<const char*>(dlsym(library, "nutik_module_version"));
    if (module == nullptr || version == nullptr) {
      tried += format("\n  {}: not a module of this program", file.string());
      continue;
    }
    if (std::string_view(version) == NUTIK_VERSION) return module;
    tried += format("\n  {}: of version {}, and this program is of {}", file.string(), version, NUTIK_VERSION);
  }
  throw InputError(
      format("{}: {} was not found; install it beside the program, or set NUTIK_MODULES to its folder. "
             "Looked for:{}",
             without, name, tried));
}

}  // namespace nutik
