// Seeded random captures, functions and masks: what the renderers are compared on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "capture/picture.hpp"
#include "capture/timeline.hpp"
#include "exposure/mask.hpp"
#include "imev/capture_source.hpp"
#include "render/output_format.hpp"
#include "render/render_plan.hpp"

namespace nutik::test {

// Light as it is computed, where every rounding shows.
inline constexpr OutputFormat kLight{ValueType::light64, 0};

// Draws with a fixed meaning per seed, whatever the standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  // A whole number of [low, high].
  std::int64_t whole(std::int64_t low, std::int64_t high) {
    const auto range = static_cast<std::uint64_t>(high - low) + 1;
    return low + static_cast<std::int64_t>(engine_() % range);
  }
  // A number of [low, high).
  double real(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  bool chance(double probability) { return real(0, 1) < probability; }
  template <typename T>
  const T& pick(const std::vector<T>& choices) {
    return choices[static_cast<std::size_t>(whole(0, static_cast<std::int64_t>(choices.size()) - 1))];
  }

 private:
  std::mt19937_64 engine_;
};

// Samples as interleaved rasters.
using Rasters = std::vector<std::vector<std::byte>>;

std::uint32_t code_at(const CaptureFormat& capture, const std::vector<std::byte>& raster,
                      std::uint64_t value);
void set_code(const CaptureFormat& capture, std::vector<std::byte>& raster, std::uint64_t value,
              std::uint32_t code);

// Rasters with still parts, parts that change now and then, and parts that change at every sample.
Rasters random_rasters(Random& random, const CaptureFormat& capture, std::uint64_t sample_count);

CaptureFormat random_format(Random& random);
Timeline random_timeline(Random& random, std::uint64_t sample_count);

// A function with control points in and around [0, duration_ns], some at edges of samples, some 1 ns
// apart, gains of both signs.
GainFunction random_function(Random& random, const Timeline& timeline);

// What kernels are built for, one by one: where a test should not wait for all of them.
struct CodeFormat {
  std::uint32_t channels;
  std::uint32_t code_bytes;
  std::uint32_t white_code;
  Transfer transfer;
};

struct RandomCase {
  std::uint64_t seed;
  CaptureFormat capture;
  Timeline timeline;
  Rasters rasters;
  std::uint32_t block_samples;
  TilePolicy policy;
  FunctionSet functions;
  Mask mask;

  explicit RandomCase(std::uint64_t seed);
  RandomCase(std::uint64_t seed, const CodeFormat& codes);
  [[nodiscard]] MemoryCapture encode() const { return encode(block_samples, policy); }
  [[nodiscard]] MemoryCapture encode(std::uint32_t samples, TilePolicy tiles) const {
    return {capture, timeline, rasters, samples, tiles};
  }
  [[nodiscard]] std::string text() const;

 private:
  RandomCase(Random random, std::uint64_t seed, const CodeFormat* codes);
};

}  // namespace nutik::test
