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
constexpr std::int64_t kMean = 1;       // pixels to each side over which noise is averaged

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
      if (differing_.inside[pixel] == 0) add_neighbours(pixel, rest, reached);
    }
    while (!reached.empty()) {
      const std::size_t pixel = reached.back();
      reached.pop_back();
      add_neighbours(pixel, rest, reached);
    }
    return rest;
  }

 private:
  void add_neighbours(std::size_t pixel, Region& rest, std::vector<std::size_t>& reached) const {
    const auto x = static_cast<std::int64_t>(pixel % width_), y = static_cast<std::int64_t>(pixel / width_);
    const auto add = [&](std::int64_t to_x, std::int64_t to_y) {
      if (to_x < 0 || to_y < 0 || to_x >= width_ || to_y >= height_) return;
      const std::size_t to = index(to_x, to_y);
      if (rest.inside[to] == 0 || left_[to] < 0) return;
      if (std::abs(mean_at(to_x, to_y) - mean_at(x, y)) > kMaxStep) return;
      rest.inside[to] = 0;
      reached.push_back(to);
    };
    add(x - 1, y);
    add(x + 1, y);
    add(x, y - 1);
    add(x, y + 1);
  }
  [[nodiscard]] double mean_at(std::int64_t x, std::int64_t y) const {
    double sum = 0;
    int count = 0;
    for (std::int64_t row = std::max<std::int64_t>(0, y - kMean); row <= std::min(height_ - 1, y + kMean); ++row) {
      for (std::int64_t column = std::max<std::int64_t>(0, x - kMean); column <= std::min(width_ - 1, x + kMean);
           ++column) {
        const float each = left_[index(column, row)];
        if (each < 0) continue;
        sum += each;
        ++count;
      }
    }
    return count > 0 ? sum / count : 0;
  }
  [[nodiscard]] std::size_t index(std::int64_t x, std::int64_t y) const {
    return static_cast<std::size_t>(y * width_ + x);
  }

  std::int64_t width_, height_;
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
