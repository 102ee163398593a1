#include "media/module.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "system/is_absent.hpp"
#include "system/own_folders.hpp"

#ifndef NUTIK_VERSION
#error "NUTIK_VERSION is not set: modules of other versions have other tables of functions"
#endif

namespace nutik {
namespace {

// Where modules may be, in the order of the search. An empty folder leaves it to the loader, which knows the run
// path that find_package(nutik) gives to whatever is linked to this library.
std::vector<std::filesystem::path> module_folders() {
  std::vector<std::filesystem::path> folders;
  if (const char* folder = std::getenv("NUTIK_MODULES"); folder != nullptr) folders.emplace_back(folder);
  for (const std::filesystem::path& folder : own_folders()) folders.push_back(folder);
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
