#include "scene/shadow.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace nutik {
namespace {

// Codes of a shadow and of the ground, as shares: at least, and how far those of colours lie apart.
constexpr double kMinRatio = 0.4, kMaxSpread = 0.1;
constexpr double kMaxStep = 0.03;       // from one pixel to the next
constexpr double kMinGround = 1.0 / 12;  // of white: on darker ground nothing is told from its shadow
constexpr std::size_t kMean = 1;        // pixels to each side over which noise is averaged

// How much light is left where the plate has its own, 1 where nothing differs; negative where that is no shadow.
template <typename Code>
std::vector<float> light_left(const Picture& picture, const Picture& plate, const Region& differing) {
  const Code *codes = picture.values<Code>().data(), *ground = plate.values<Code>().data();
  const std::size_t channels = picture.shape.channels;
  std::vector<float> left(differing.inside.size(), 1.0F);
  for (std::size_t pixel = 0; pixel < left.size(); ++pixel) {
    if (differing.inside[pixel] == 0) continue;
    double least = HUGE_VAL, most = -HUGE_VAL, sum = 0;
    for (std::size_t i = pixel * channels; i < (pixel + 1) * channels; ++i) {
      const double floor = kMinGround * picture.white_code / 4;
      const double ratio = (codes[i] + floor) / (ground[i] + floor);
      least = std::min(least, ratio);
      most = std::max(most, ratio);
      sum += ground[i];
    }
    const bool is_shadow = least >= kMinRatio && most <= 1 && most - least <= kMaxSpread &&
                           sum >= kMinGround * picture.white_code * static_cast<double>(channels);
    left[pixel] = is_shadow ? static_cast<float>((least + most) / 2) : -1.0F;
  }
  return left;
}

class ShadowFlood {
 public:
  ShadowFlood(const Region& differing, std::vector<float> left)
      : width_(differing.width), height_(differing.height), differing_(differing), left_(std::move(left)) {}

  [[nodiscard]] Region rest() {
    Region rest = differing_;
    std::vector<std::size_t> reached;
    for (std::size_t pixel = 0; pixel < left_.size(); ++pixel) {
      if (differing_.inside[pixel] == 0) continue;
      for_each_neighbour(pixel, [&](std::size_t from) {
        if (differing_.inside[from] == 0) spread(from, pixel, rest, reached);
      });
    }
    while (!reached.empty()) {
      const std::size_t pixel = reached.back();
      reached.pop_back();
      for_each_neighbour(pixel, [&](std::size_t to) { spread(pixel, to, rest, reached); });
    }
    return rest;
  }

 private:
  template <typename Use>
  void for_each_neighbour(std::size_t pixel, Use use) const {
    const std::size_t x = pixel % width_, y = pixel / width_;
    if (x > 0) use(pixel - 1);
    if (x + 1 < width_) use(pixel + 1);
    if (y > 0) use(pixel - width_);
    if (y + 1 < height_) use(pixel + width_);
  }
  void spread(std::size_t from, std::size_t to, Region& rest, std::vector<std::size_t>& reached) const {
    if (rest.inside[to] == 0 || left_[to] < 0 || std::abs(mean_at(to) - mean_at(from)) > kMaxStep) return;
    rest.inside[to] = 0;
    reached.push_back(to);
  }
  [[nodiscard]] double mean_at(std::size_t pixel) const {
    const std::size_t x = pixel % width_, y = pixel / width_;
    double sum = 0;
    int count = 0;
    for (std::size_t row = y - std::min(y, kMean); row <= std::min(height_ - 1, y + kMean); ++row) {
      for (std::size_t column = x - std::min(x, kMean); column <= std::min(width_ - 1, x + kMean); ++column) {
        const float each = left_[row * width_ + column];
        if (each < 0) continue;
        sum += each;
        ++count;
      }
    }
    return count > 0 ? sum / count : 0;
  }

  std::size_t width_, height_;
  const Region& differing_;
  std::vector<float> left_;
};

}  // namespace

Region without_shadow(const Picture& picture, const Picture& plate, const Region& differing) {
  return ShadowFlood(differing, picture.type == ValueType::code8
                                    ? light_left<std::uint8_t>(picture, plate, differing)
                                    : light_left<std::uint16_t>(picture, plate, differing))
      .rest();
}

}  // namespace nutik
