#include "media/module.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"

#ifndef NUTIK_INSTALLED_MODULES
#error "NUTIK_INSTALLED_MODULES is not set: the folder of installed modules, relative to the program's"
#endif

namespace nutik {
namespace {

std::vector<std::filesystem::path> module_folders() {
  std::vector<std::filesystem::path> folders;
  if (const char* folder = std::getenv("NUTIK_MODULES"); folder != nullptr) folders.emplace_back(folder);
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) {
    folders.push_back(program.parent_path());
    folders.push_back(program.parent_path() / NUTIK_INSTALLED_MODULES);
  }
  return folders;
}

// The entry points of the module in `name`, which stand behind its `symbol`; `without` says what lacks without it.
const void* load_module(const char* name, const char* symbol, const char* without) {
  std::string tried;
  for (const std::filesystem::path& folder : module_folders()) {
    const std::filesystem::path file = folder / name;
    if (!std::filesystem::exists(file)) {
      tried += format("\n  {}: no such file", file.string());
      continue;
    }
    // Never closed: OpenCV's and FFmpeg's threads may outlive any place where that would be safe.
    void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
      tried += format("\n  {}", dlerror());
      continue;
    }
    if (const void* module = dlsym(library, symbol)) return module;
    tried += format("\n  {}: not a module of this program", file.string());
  }
  throw InputError(
      format("{}: {} was not found; install it beside the program, or set NUTIK_MODULES to its folder. "
             "Looked for:{}",
             without, name, tried));
}

template <typename Module>
const Module& module() {
  static const void* const loaded = load_module(Module::kFile, Module::kSymbol, Module::kWithout);
  return *static_cast<const Module*>(loaded);
}

}  // namespace

const VideoModule& video_module() { return module<VideoModule>(); }
const StillModule& still_module() { return module<StillModule>(); }

}  // namespace nutik
