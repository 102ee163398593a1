#include "scene/moments.hpp"

#include <algorithm>
#include <cmath>

#include "scene/telling_places.hpp"

namespace nutik {
namespace {

// Whether two places touch or overlap when each is grown by half of so many cells.
bool overlap(const SubjectPlace& a, const SubjectPlace& b, std::size_t columns, std::size_t gap) {
  for (const std::size_t cell : a.cells) {
    const std::size_t x = cell % columns, y = cell / columns;
    for (std::size_t row = y - std::min(y, gap); row <= y + gap; ++row) {
      const std::size_t first = row * columns + x - std::min(x, gap);
      const std::size_t last = row * columns + std::min(x + gap, columns - 1);
      const auto found = std::ranges::lower_bound(b.cells, first);
      if (found != b.cells.end() && *found <= last) return true;
    }
  }
  return false;
}

class Chooser {
 public:
  Chooser(const SubjectTrack& track, std::uint32_t count, std::uint32_t gap_pixels)
      : track_(track), count_(count), gap_(gap_pixels == 0 ? 0 : (gap_pixels - 1) / track.cell_side + 1) {}

  // Those nearest to wishes that are spread evenly over candidates.
  void add_evenly(const Places& candidates, MomentSpacing spacing) {
    std::vector<double> along{0};  // how far each candidate is along the way, or in time
    for (std::size_t i = 1; i < candidates.size(); ++i) {
      const SubjectPlace &from = *candidates[i - 1], &to = *candidates[i];
      along.push_back(along.back() + (spacing == MomentSpacing::time
                                          ? static_cast<double>(to.sample - from.sample)
                                          : distance(from.centre, to.centre)));
    }
    for (std::uint32_t i = 0; i < count_; ++i) {
      const double wanted = count_ == 1 ? along.back() / 2 : along.back() * i / (count_ - 1);
      // Within half of the way to the next wish.
      const double reach = count_ == 1 ? along.back() : along.back() / (2 * (count_ - 1));
      const SubjectPlace* best = nullptr;
      double best_away = reach;
      for (std::size_t k = 0; k < candidates.size(); ++k) {
        const double away = std::abs(along[k] - wanted);
        if (away > best_away || (best != nullptr && away == best_away) || !is_free(*candidates[k])) continue;
        best = candidates[k];
        best_away = away;
      }
      if (best != nullptr) chosen_.push_back(best);
    }
  }

  // What there is room for beside those, the furthest first.
  void add_others(const Places& candidates) {
    while (chosen_.size() < count_) {
      const SubjectPlace* best = nullptr;
      double furthest = -1;
      for (const SubjectPlace* candidate : candidates) {
        double nearest = HUGE_VAL;
        for (const SubjectPlace* other : chosen_) {
          nearest = std::min(nearest, distance(candidate->centre, other->centre));
        }
        if (nearest <= furthest || !is_free(*candidate)) continue;
        furthest = nearest;
        best = candidate;
      }
      if (best == nullptr) return;
      chosen_.push_back(best);
    }
  }

  [[nodiscard]] std::vector<SubjectPlace> chosen() const {
    std::vector<SubjectPlace> moments;
    for (const SubjectPlace* each : chosen_) moments.push_back(*each);
    std::ranges::sort(moments, {}, &SubjectPlace::sample);
    return moments;
  }

 private:
  [[nodiscard]] bool is_free(const SubjectPlace& place) const {
    return std::ranges::none_of(chosen_, [&](const SubjectPlace* other) {
      return overlap(place, *other, track_.cell_columns, gap_);
    });
  }

  const SubjectTrack& track_;
  std::uint32_t count_;
  std::size_t gap_;  // in cells
  Places chosen_;
};

}  // namespace

std::vector<SubjectPlace> choose_moments(const SubjectTrack& track, std::uint32_t count,
                                         MomentSpacing spacing, std::uint32_t gap_pixels) {
  const Places candidates = telling_places(track.places);
  const Places whole = whole_places(candidates);
  Chooser chooser(track, count, gap_pixels);
  if (const Places& most = whole.size() >= count ? whole : candidates; !most.empty()) {
    chooser.add_evenly(most, spacing);
  }
  chooser.add_others(whole);
  chooser.add_others(candidates);
  return chooser.chosen();
}

}  // namespace nutik
