#include "studio/canvas/outlines.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

namespace nutik::studio {
namespace {

constexpr int kNone = -1;

// Whose outline lies between two pixels.
int tag_between(std::uint8_t a, std::uint8_t b) { return a == b ? kNone : std::max(a, b); }

// A line that grows while neighbours go on with the same tag.
struct Run {
  int tag = kNone, from = 0;

  // Where another one begins, or none: the line up to there.
  template <typename Line>
  void go_on(Outlines& outlines, int next, int at, const Line& line) {
    if (next == tag) return;
    if (tag != kNone) outlines[static_cast<std::uint8_t>(tag)] += line(from, at);
    tag = next;
    from = at;
  }
};

}  // namespace

// Row by row, as the mask lies in memory: this is done anew at each move of a brush.
Outlines outlines_of(const Mask& mask) {
  Outlines outlines;
  const int width = static_cast<int>(mask.width), height = static_cast<int>(mask.height);
  const auto row_at = [&](int y) { return mask.tags.data() + static_cast<std::size_t>(y) * mask.width; };
  const auto are_same = [&](const std::uint8_t* a, const std::uint8_t* b) {
    return std::memcmp(a, b, mask.width) == 0;
  };
  std::vector<Run> downwards(mask.width);  // left of each pixel
  for (int y = 0; y <= height; ++y) {
    const std::uint8_t *row = y < height ? row_at(y) : nullptr, *above = y > 0 ? row_at(y - 1) : nullptr;
    if (row != nullptr && above != nullptr && are_same(above, row)) continue;
    for (int x = 1; x < width; ++x)
      downwards[static_cast<std::size_t>(x)].go_on(
          outlines, row == nullptr ? kNone : tag_between(row[x - 1], row[x]), y,
          [x](int from, int to) { return QLine(x, from, x, to); });
    if (row == nullptr || above == nullptr) continue;
    Run along;
    const auto line = [y](int from, int to) { return QLine(from, y, to, y); };
    for (int x = 0; x < width; ++x) along.go_on(outlines, tag_between(above[x], row[x]), x, line);
    along.go_on(outlines, kNone, width, line);
  }
  return outlines;
}

}  // namespace nutik::studio
