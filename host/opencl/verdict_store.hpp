// Keeps the verdicts of self-tests beside the binaries of kernels.
//
//   in:      a device, the folder of its binaries, the options that a pair of programs was built with
//   out:     the verdict on this pair, if it was tested before
//   always:  a verdict is used only if device, driver, sources and options are the very ones that were tested. It is
//            as old as the binaries: whoever builds one of them anew does not ask for it, and replaces it
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "opencl/opencl_api.hpp"
#include "opencl/self_test.hpp"

namespace nutik {

// What a picture is made with.
struct TestedPrograms {
  Precision precision;
  std::string expose_options;
  std::string develop_options;
  bool make_codes;  // else light only

  [[nodiscard]] std::string text() const {
    return expose_options + '\n' + develop_options + (make_codes ? "\ncodes\n" : "\nlight\n");
  }
};

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

}  // namespace nutik
