// Hard cases: small captures and functions that are chosen because something could go wrong on them.
//
//   name      as a test is called
//   reason    what could go wrong
//   make()    the case itself; cheap but for its rasters, which are drawn one at a time
//
// Every renderer and every arithmetic is held to them (tests/render/hard_cases_test.cpp,
// tests/opencl/hard_cases_test.cpp, tools/check_kernels). All captures are lossless: what pixels hold is what was
// drawn.
#pragma once

#include <cstdint>
#include <functional>
#include <ostream>
#include <span>
#include <vector>

#include "capture/picture.hpp"
#include "capture/timeline.hpp"
#include "exposure/mask.hpp"
#include "imev/capture_source.hpp"
#include "render/render_plan.hpp"

namespace nutik::test {

// Sample k as an interleaved raster.
using DrawSample = std::function<std::vector<std::byte>(std::uint64_t k)>;

struct HardCase {
  CaptureFormat capture;
  Timeline timeline;
  DrawSample sample;
  FunctionSet functions;
  Mask mask;
  std::uint32_t block_samples = 64;
  TilePolicy policy = TilePolicy::automatic;

  // The capture, for one render: only samples that the functions need are kept.
  [[nodiscard]] StreamingCapture open() const { return open(block_samples, policy); }
  [[nodiscard]] StreamingCapture open(std::uint32_t samples, TilePolicy tiles) const;
};

struct NamedHardCase {
  const char* name;
  const char* reason;
  HardCase (*make)();

  friend std::ostream& operator<<(std::ostream& out, const NamedHardCase& hard) { return out << hard.reason; }
};

[[nodiscard]] std::span<const NamedHardCase> hard_cases();

}  // namespace nutik::test
