// The kernels' programs: each is compiled once on a machine, and tested once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "opencl/opencl_api.hpp"
#include "opencl/self_test.hpp"

namespace nutik {

// What a picture is made with.
struct TestedPrograms {
  struct Program {
    std::string name, options;
  };
  Precision precision;
  std::vector<Program> programs;
  std::string made;  // by them: `codes`, `light`, `combined light`

  [[nodiscard]] std::string text() const {
    std::string text;
    for (const Program& each : programs) text += each.options + '\n';
    return text + made + '\n';
  }
};

// Keeps the verdicts of self-tests beside the binaries of kernels.
//
//   in:      a device, the folder of its binaries, the options that programs were built with
//   out:     the verdict on them, if they were tested before
//   always:  a verdict is used only if device, driver, sources and options are the very ones that were tested. It is
//            as old as the binaries: whoever builds one of them anew does not ask for it, and replaces it
class VerdictStore {
 public:
  // `folder` may be empty: nothing is kept then.
  VerdictStore(const cl::Device& device, std::filesystem::path folder);

  [[nodiscard]] std::optional<Verdict> find(const TestedPrograms& programs) const;
  // A folder that cannot be written costs another test next time.
  void keep(const TestedPrograms& programs, const Verdict& verdict) const;

  // The worst verdict on each arithmetic that was tested.
  [[nodiscard]] std::map<Precision, Verdict> all() const;

 private:
  [[nodiscard]] std::string key_of(const TestedPrograms& programs) const;

  std::string device_key_;
  std::filesystem::path folder_;
};

// Builds programs and keeps their binaries.
//
//   always:  a cached binary is used only where source, options, device and driver are the very ones it was built with:
//            its file holds them in full and they are compared. A damaged or foreign file is rebuilt
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

}  // namespace nutik
