// Builds OpenCL programs and keeps their binaries, so that a kernel is compiled once on a machine.
//
// A cached binary is used only where source, options, device and driver are the very ones it was built
// with: its file holds them in full and they are compared. A damaged or foreign file is rebuilt.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "opencl/opencl_api.hpp"

namespace nutik {

class ProgramStore {
 public:
  using Announce = std::function<void(const std::string&)>;

  // `cache_folder` may be empty: nothing is kept then. `announce` is told when a build starts.
  ProgramStore(cl::Context context, cl::Device device, std::filesystem::path cache_folder, Announce announce);

  // A built program: the one made before, else the cached binary, else a new build. Throws DeviceError
  // with program, options and the compiler's log.
  cl::Program get(const std::string& name, const std::string& source, const std::string& options);

  // Whether a program that get() returned was built here, not loaded from the cache.
  [[nodiscard]] bool was_built(const std::string& name, const std::string& options) const;

  // Writes the binaries of programs that were built since. To be called after their kernels first ran:
  // PoCL compiles a kernel's work-group function only then, and a binary saved earlier lacks it (build
  // and first run take 110 ms from such a binary, 4 ms from a whole one).
  void save_new_binaries();

 private:
  struct Entry {
    cl::Program program;
    std::string name;
    std::string options;
    bool was_built = false;
    bool is_saved = false;
  };

  [[nodiscard]] std::filesystem::path file_for(const std::string& name, const std::string& key) const;
  bool load(const std::string& name, const std::string& key, const std::string& options,
            cl::Program& program) const;
  [[nodiscard]] cl::Program build(const std::string& name, const std::string& source,
                                  const std::string& options) const;

  cl::Context context_;
  cl::Device device_;
  std::filesystem::path cache_folder_;
  Announce announce_;
  std::string device_key_;
  std::map<std::string, Entry> entries_;  // by key
};

// A device with its driver, in lines: what a binary was built for.
[[nodiscard]] std::string identity_of(const cl::Device& device);

}  // namespace nutik
