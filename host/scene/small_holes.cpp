#include "scene/small_holes.hpp"

#include <cstdint>
#include <vector>

namespace nutik {
namespace {

enum class Seen : std::uint8_t { no, now, open };  // open: it belongs to more than a small hole

class HoleFiller {
 public:
  HoleFiller(Region& region, std::size_t max_pixels)
      : region_(region), max_pixels_(max_pixels), seen_(region.inside.size(), Seen::no) {}

  void fill() {
    for (std::size_t pixel = 0; pixel < seen_.size(); ++pixel) {
      if (region_.inside[pixel] != 0 || seen_[pixel] != Seen::no) continue;
      const bool is_small = spreads_little(pixel);
      for (const std::size_t each : part_) {
        if (is_small) region_.inside[each] = 1;
        seen_[each] = Seen::open;
      }
    }
  }

 private:
  // Gathers what hangs together with a pixel, until it is too much for a small hole.
  bool spreads_little(std::size_t first) {
    part_.assign(1, first);
    seen_[first] = Seen::now;
    for (std::size_t i = 0; i < part_.size(); ++i) {
      const std::size_t x = part_[i] % region_.width, y = part_[i] / region_.width;
      if (x == 0 || y == 0 || x + 1 == region_.width || y + 1 == region_.height) return false;
      for (std::size_t row = y - 1; row <= y + 1; ++row) {
        for (std::size_t beside = row * region_.width + x - 1; beside <= row * region_.width + x + 1;
             ++beside) {
          if (region_.inside[beside] != 0 || seen_[beside] == Seen::now) continue;
          if (seen_[beside] == Seen::open) return false;
          seen_[beside] = Seen::now;
          part_.push_back(beside);
        }
      }
      if (part_.size() > max_pixels_) return false;
    }
    return true;
  }

  Region& region_;
  std::size_t max_pixels_;
  std::vector<Seen> seen_;
  std::vector<std::size_t> part_;
};

}  // namespace

void fill_small_holes(Region& region, std::size_t max_pixels) { HoleFiller(region, max_pixels).fill(); }

}  // namespace nutik
