// What the host can ask the kernels' builds for, and few builds in which any two of it meet.
//
//   in:      the parameters' values, and which of them exclude each other (kernel_builds.cpp, with the reasons)
//   out:     every build that is left; or few of them, the shapes that devices get among them
//   always:  any two values that some build joins are joined by one of the few, too
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "opencl/opencl_renderer.hpp"
#include "render/renderer.hpp"

namespace nutik::test {

// How a kernel turns codes into light; kernels/light.clh.
enum class LightKind { linear, curve, pieces, table, near_table };

struct KernelBuild {
  Precision precision;
  LightKind light;
  std::uint32_t lanes;
  std::uint32_t item_pixels;
  std::uint32_t item_tiles;
  std::uint32_t code_bytes;
  std::uint32_t channels;
  bool fuses;  // multiplication and addition
  OutputFormat output;

  // For example double-table-8x16x3-1byte-3channels-fused-code16: 8 lanes, of 16 pixels of 3 tiles.
  [[nodiscard]] std::string name() const;
  // A transfer function for which the host takes this light.
  [[nodiscard]] Transfer transfer() const;
  [[nodiscard]] OpenClOptions options() const;
};

// What is not built, and why.
struct Exclusion {
  const char* reason;
  bool (*applies)(const KernelBuild& build);
};
[[nodiscard]] std::span<const Exclusion> kernel_build_exclusions();

// Every combination of values, whether or not the host asks for it.
[[nodiscard]] std::vector<KernelBuild> all_combinations();

// Those that no exclusion applies to.
[[nodiscard]] std::vector<KernelBuild> possible_builds();

// Few of them.
[[nodiscard]] std::vector<KernelBuild> pairwise(const std::vector<KernelBuild>& builds);

// A parameter's value of a build, as text: `lanes 8`. As many for each build, in the same order.
[[nodiscard]] std::vector<std::string> values_of(const KernelBuild& build);

}  // namespace nutik::test
