// Where each pixel of a picture goes in another (dense optical flow).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>

namespace nutik {

struct FlowVector {
  float x = 0, y = 0;  // pixels, right and down
};

inline float length(const FlowVector& flow) { return std::sqrt(flow.x * flow.x + flow.y * flow.y); }

// How far motion is believed that leaves this share of what changed: not where it explains less than 0.3 of it, wholly
// from 0.7 on.
constexpr float kExplainsLittle = 0.3F;
inline float believed_of(float left) {
  const float share = std::clamp((1 - left - kExplainsLittle) / 0.4F, 0.0F, 1.0F);
  return share * share * (3 - 2 * share);
}

struct GreyPlane {
  const std::uint8_t* pixels = nullptr;
  std::uint32_t width = 0, height = 0;
  std::size_t stride = 0;  // bytes from row to row
};

class FlowFinder {
 public:
  // Planes with a shorter side have no flow.
  static constexpr std::uint32_t kMinSide = 24;

  virtual ~FlowFinder() = default;

  enum class Detail { all, rough };  // rough: at a quarter of the sides that flow is found at otherwise

  // Writes where each pixel of `from` goes, row by row, into `flow`. Both planes are of one size. The same planes give
  // the same flow. One thread may ask at a time.
  virtual void find(const GreyPlane& from, const GreyPlane& to, std::span<FlowVector> flow,
                    Detail detail = Detail::all) = 0;
};

// Throws InputError where nutik-motion.so is not found.
[[nodiscard]] std::unique_ptr<FlowFinder> open_flow_finder();

}  // namespace nutik
