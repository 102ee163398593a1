#include "studio/canvas/outlines.hpp"

#include <algorithm>
#include <cstring>

namespace nutik::studio {
namespace {

// A line that grows while neighbours go on with the same tag.
class Run {
 public:
  Run(Outlines& outlines, bool is_vertical, int across)
      : outlines_(outlines), is_vertical_(is_vertical), across_(across) {}
  ~Run() { end(); }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  // Between two pixels, at `along`.
  void add(std::uint8_t a, std::uint8_t b, int along) {
    const int tag = a == b ? kNone : std::max(a, b);
    if (tag == tag_ && along == to_) {
      ++to_;
      return;
    }
    end();
    tag_ = tag;
    from_ = along;
    to_ = along + 1;
  }

 private:
  static constexpr int kNone = -1;

  void end() {
    if (tag_ == kNone) return;
    const QPoint from(across_, from_), to(across_, to_);
    outlines_[static_cast<std::uint8_t>(tag_)] +=
        is_vertical_ ? QLine(from, to) : QLine(from.y(), from.x(), to.y(), to.x());
  }

  Outlines& outlines_;
  bool is_vertical_;
  int across_;
  int tag_ = kNone, from_ = 0, to_ = 0;
};

}  // namespace

Outlines outlines_of(const Mask& mask) {
  Outlines outlines;
  const int width = static_cast<int>(mask.width), height = static_cast<int>(mask.height);
  const auto row_at = [&](int y) { return mask.tags.data() + static_cast<std::size_t>(y) * mask.width; };
  for (int y = 1; y < height; ++y) {
    const std::uint8_t *above = row_at(y - 1), *row = row_at(y);
    if (std::memcmp(above, row, mask.width) == 0) continue;
    Run run(outlines, false, y);
    for (int x = 0; x < width; ++x) run.add(above[x], row[x], x);
  }
  for (int x = 1; x < width; ++x) {
    Run run(outlines, true, x);
    const std::uint8_t* pixel = mask.tags.data() + x;
    for (int y = 0; y < height; ++y, pixel += mask.width) run.add(pixel[-1], *pixel, y);
  }
  return outlines;
}

}  // namespace nutik::studio
