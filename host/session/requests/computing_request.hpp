// Which renderer computes pictures, with how much memory. A value: two are equal when they ask for the same.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "render/precision.hpp"
#include "session/memory_budget.hpp"

namespace nutik {

// The reference computes in double on the processor, slowly, and needs no OpenCL.
enum class RendererKind { opencl, reference };

struct ComputingRequest {
  RendererKind renderer = RendererKind::opencl;

  // An OpenCL device: its number in list_devices(), or part of its name or platform, in any case. Empty: the first.
  // Several with commas between them, or `all`, make each picture together.
  std::string device;
  std::optional<Precision> precision;  // none: for each picture the fastest whose error bound is small enough
  // Keeps built kernels. None: default_cache_folder(); an empty path: they are not kept.
  std::optional<std::filesystem::path> cache_folder;

  MemoryBudget memory = MemoryBudget::of_machine();

  bool tests_drivers = true;  // false: new kernels are used without a self-test (opencl/self_test.hpp)

  // With what the environment says: NUTIK_DEVICE names the device, NUTIK_SELF_TEST=off does without self-tests.
  static ComputingRequest of_environment();

  friend bool operator==(const ComputingRequest&, const ComputingRequest&) = default;
};

}  // namespace nutik
