#include "media/module.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <new>
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

// OpenCV loads oneTBB, which ends the process where its allocator (tbbmalloc) finds no memory then: so that has some,
// before. Where there is no such allocator, oneTBB does without.
void make_room_for_tbb() {
  void* allocator = dlopen("libtbbmalloc.so.2", RTLD_LAZY | RTLD_LOCAL);
  if (allocator == nullptr) return;
  const auto allocate = reinterpret_cast<void* (*)(std::size_t)>(dlsym(allocator, "scalable_malloc"));
  const auto release = reinterpret_cast<void (*)(void*)>(dlsym(allocator, "scalable_free"));
  if (allocate == nullptr || release == nullptr) return;
  void* some = allocate(1);
  if (some == nullptr) throw std::bad_alloc();
  release(some);
}

}  // namespace

const void* load_module(const char* name, const char* symbol, const char* without) {
  std::string tried;
  make_room_for_tbb();
  for (const std::filesystem::path& folder : module_folders()) {
    const std::filesystem::path file = folder / name;
    if (!folder.empty() && is_absent(file)) {
      tried += format("\n  {}: no such file", file.string());
      continue;
    }
    // Never closed: OpenCV's and FFmpeg's threads may outlive any place where that would be safe. Lazily: what
    // libraries below a module call is looked up when they call it; what a module itself calls, now (-z now).
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
