// Which of what differs from the plate is a shadow.
#include "scene/clean_plate.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
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

// Without noise: of the pixels round it that may be shadow.
double mean_at(std::size_t pixel, std::span<const float> left, std::size_t width, std::size_t height) {
  const std::size_t x = pixel % width, y = pixel / width;
  double sum = 0;
  int count = 0;
  for (std::size_t row = y - std::min(y, kMean); row <= std::min(height - 1, y + kMean); ++row) {
    for (std::size_t column = x - std::min(x, kMean); column <= std::min(width - 1, x + kMean); ++column) {
      const float each = left[row * width + column];
      if (each < 0) continue;
      sum += each;
      ++count;
    }
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace

Region without_shadow(const Picture& picture, const Picture& plate, const Region& differing) {
  const std::vector<float> left = picture.type == ValueType::code8
                                      ? light_left<std::uint8_t>(picture, plate, differing)
                                      : light_left<std::uint16_t>(picture, plate, differing);
  const std::size_t width = differing.width, height = differing.height;
  const auto for_each_neighbour = [&](std::size_t pixel, auto use) {
    const std::size_t x = pixel % width, y = pixel / width;
    if (x > 0) use(pixel - 1);
    if (x + 1 < width) use(pixel + 1);
    if (y > 0) use(pixel - width);
    if (y + 1 < height) use(pixel + width);
  };
  Region rest = differing;
  std::vector<std::size_t> reached;
  const auto spread = [&](std::size_t from, std::size_t to) {
    if (rest.inside[to] == 0 || left[to] < 0) return;
    if (std::abs(mean_at(to, left, width, height) - mean_at(from, left, width, height)) > kMaxStep) return;
    rest.inside[to] = 0;
    reached.push_back(to);
  };
  for (std::size_t pixel = 0; pixel < left.size(); ++pixel) {
    if (differing.inside[pixel] == 0) continue;
    for_each_neighbour(pixel, [&](std::size_t from) {
      if (differing.inside[from] == 0) spread(from, pixel);
    });
  }
  while (!reached.empty()) {
    const std::size_t pixel = reached.back();
    reached.pop_back();
    for_each_neighbour(pixel, [&](std::size_t to) { spread(pixel, to); });
  }
  return rest;
}

}  // namespace nutik
