#include "scene/clean_plate.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace nutik {
namespace {

// In pixels, to either side of an edge: a soft one lies between.
constexpr std::int64_t kBeside = 3;
constexpr std::uint64_t kMinPixels = 16;  // of a border
constexpr std::uint32_t kClearly = 2;     // times the picture's edge

template <typename Code>
class Edges {
 public:
  Edges(const Picture& picture, const Picture& plate, const Region& region, std::uint32_t margin)
      : picture_(picture.values<Code>().data()),
        plate_(plate.values<Code>().data()),
        channels_(picture.shape.channels),
        region_(region),
        inward_(std::int64_t{margin} + kBeside),
        outward_(std::max<std::int64_t>(kBeside + 1 - margin, 1)) {}

  [[nodiscard]] double share(std::uint32_t by_codes) {
    for (std::int64_t y = 0; y < region_.height; ++y) {
      for (std::int64_t x = 0; x < region_.width; ++x) {
        if (!holds(x, y)) continue;
        for (const auto& [right, down] :
             {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
          add(x, y, right, down, by_codes);
        }
      }
    }
    return pixels_ < kMinPixels ? 0 : static_cast<double>(of_plate_) / static_cast<double>(pixels_);
  }

 private:
  // A border pixel, and the way out of the region.
  void add(std::int64_t x, std::int64_t y, std::int64_t right, std::int64_t down, std::uint32_t by_codes) {
    const std::int64_t out_x = x + outward_ * right, out_y = y + outward_ * down;
    const std::int64_t in_x = x - inward_ * right, in_y = y - inward_ * down;
    if (!lies_in(x + right, y + down) || holds(x + right, y + down) || !holds(in_x, in_y)) return;
    if (!lies_in(out_x, out_y) || holds(out_x, out_y)) return;
    ++pixels_;
    const std::size_t in = index(in_x, in_y) * channels_, out = index(out_x, out_y) * channels_;
    const std::uint32_t of_plate = apart(plate_, in, out);
    if (of_plate > by_codes && of_plate > kClearly * apart(picture_, in, out)) ++of_plate_;
  }

  [[nodiscard]] std::uint32_t apart(const Code* codes, std::size_t a, std::size_t b) const {
    std::uint32_t most = 0;
    for (std::size_t channel = 0; channel < channels_; ++channel) {
      const std::uint32_t first = codes[a + channel], second = codes[b + channel];
      most = std::max(most, std::max(first, second) - std::min(first, second));
    }
    return most;
  }
  [[nodiscard]] bool lies_in(std::int64_t x, std::int64_t y) const {
    return x >= 0 && y >= 0 && x < region_.width && y < region_.height;
  }
  [[nodiscard]] bool holds(std::int64_t x, std::int64_t y) const {
    return lies_in(x, y) && region_.inside[index(x, y)] != 0;
  }
  [[nodiscard]] std::size_t index(std::int64_t x, std::int64_t y) const {
    return static_cast<std::size_t>(y) * region_.width + static_cast<std::size_t>(x);
  }

  const Code *picture_, *plate_;
  std::size_t channels_;
  const Region& region_;
  std::int64_t inward_, outward_;
  std::uint64_t pixels_ = 0, of_plate_ = 0;
};

}  // namespace

double plate_edge_share(const Picture& picture, const Picture& plate, const Region& region,
                        std::uint32_t by_codes, std::uint32_t margin) {
  return picture.type == ValueType::code8
             ? Edges<std::uint8_t>(picture, plate, region, margin).share(by_codes)
             : Edges<std::uint16_t>(picture, plate, region, margin).share(by_codes);
}

}  // namespace nutik
