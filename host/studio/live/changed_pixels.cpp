#include "studio/live/changed_pixels.hpp"

#include <algorithm>
#include <cstring>
#include <variant>
#include <vector>

namespace nutik::studio {
namespace {

// For exposures by functions.
std::vector<std::uint8_t> changed_functions(const ExposureRequest& before, const ExposureRequest& now) {
  const FunctionSet &a = *std::get<Shared<FunctionSet>>(before.gains),
                    &b = *std::get<Shared<FunctionSet>>(now.gains);
  std::vector<std::uint8_t> changed;
  const auto add_missing = [&changed](const FunctionSet& of, const FunctionSet& in) {
    for (const auto& [tag, function] : of) {
      const auto found = in.find(tag);
      if (found == in.end() || !(found->second == function)) changed.push_back(tag);
    }
  };
  add_missing(a, b);
  add_missing(b, a);
  return changed;
}

}  // namespace

QRect changed_pixels(const SharedMask& before, const SharedMask& now, const QRect& everything) {
  if (!before && !now) return {};
  if (!before || !now) return everything;
  const Mask &a = (*before)->mask, &b = (*now)->mask;
  if (&a == &b) return {};
  if (a.is_soft() || b.is_soft() || a.width != b.width || a.height != b.height) return everything;
  const std::size_t width = a.width;
  QRect changed;
  for (std::uint32_t y = 0; y < a.height; ++y) {
    const std::uint8_t *row_a = a.tags.data() + y * width, *row_b = b.tags.data() + y * width;
    if (std::memcmp(row_a, row_b, width) == 0) continue;
    const auto first = std::mismatch(row_a, row_a + width, row_b).first - row_a;
    auto last = static_cast<std::ptrdiff_t>(width) - 1;
    while (row_a[last] == row_b[last]) --last;
    changed |= QRect(QPoint(static_cast<int>(first), static_cast<int>(y)),
                     QPoint(static_cast<int>(last), static_cast<int>(y)));
  }
  return changed;
}

QRect TagBoxes::of(const SharedMask& mask, std::uint8_t tag, const QRect& everything) {
  if (!mask || (*mask)->mask.is_soft()) return everything;
  const Mask& tags = (*mask)->mask;
  if (!mask_ || &(*mask_)->mask != &tags) {
    mask_ = mask;
    boxes_.clear();
    auto run = tags.tags.begin();
    for (std::uint32_t y = 0; y < tags.height; ++y) {
      const auto row = run, row_end = row + tags.width;
      while (run != row_end) {
        const auto end = std::find_if(run, row_end, [of = *run](std::uint8_t other) { return other != of; });
        boxes_[*run] |= QRect(QPoint(static_cast<int>(run - row), static_cast<int>(y)),
                              QPoint(static_cast<int>(end - row) - 1, static_cast<int>(y)));
        run = end;
      }
    }
  }
  return boxes_[tag];
}

QRect OutdatedPixels::since_last(const ExposureRequest& request, const QRect& seen, int divisor) {
  if (!last_ || last_->seen != seen || last_->divisor != divisor) return seen;
  if (request.is_plain() || last_->request.is_plain()) return seen;
  ExposureRequest same = last_->request;
  same.mask = request.mask;
  same.gains = request.gains;
  if (!(same == request)) return seen;
  QRect changed = changed_pixels(last_->request.mask, request.mask, seen);
  for (const std::uint8_t tag : changed_functions(last_->request, request))
    changed |= boxes_.of(request.mask, tag, seen);
  return changed;
}

QRect OutdatedPixels::to_expose(const ExposureRequest& request, const QRect& seen, int divisor, bool is_shown) {
  const QRect changed = since_last(request, seen, divisor);
  // Only the last of several waiting requests is answered.
  outdated_ = is_shown ? changed : outdated_ | changed;
  last_ = Last{request, seen, divisor};
  const QRect asked = outdated_ & seen;
  // An answer is waited for, whatever it shows.
  return asked.isEmpty() ? QRect(seen.topLeft(), QSize(1, 1)) : asked;
}

}  // namespace nutik::studio
