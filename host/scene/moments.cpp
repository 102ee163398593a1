#include "scene/moments.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace nutik {
namespace {

double usual_size(const Places& places) {
  return usual(places, [](const SubjectPlace& place) { return static_cast<double>(place.cells.size()); });
}

void erase_smaller(Places& places, double cells, bool only_cut_off) {
  std::erase_if(places, [&](const SubjectPlace* place) {
    return static_cast<double>(place->cells.size()) < cells && (place->is_cut_off || !only_cut_off);
  });
}

bool share_a_cell(const SubjectPlace& a, const SubjectPlace& b) {
  auto of_a = a.cells.begin(), of_b = b.cells.begin();
  while (of_a != a.cells.end() && of_b != b.cells.end()) {
    if (*of_a == *of_b) return true;
    *of_a < *of_b ? ++of_a : ++of_b;
  }
  return false;
}

}  // namespace

double usual(const Places& places, const std::function<double(const SubjectPlace&)>& measure) {
  std::vector<std::pair<double, std::size_t>> values;  // and how many cells have it
  std::size_t cells = 0, below = 0;
  const bool are_shadows = std::ranges::all_of(places, [](const SubjectPlace* place) { return place->solid == 0; });
  for (const SubjectPlace* place : places) {
    values.emplace_back(measure(*place), are_shadows ? place->cells.size() : place->solid);
    cells += values.back().second;
  }
  std::ranges::sort(values);
  for (const auto& [value, of_place] : values) {
    below += of_place;
    if (2 * below > cells) return value;
  }
  return 0;
}

Places telling_places(const std::vector<SubjectPlace>& places) {
  constexpr double kMinSize = 0.25, kMinContrast = 0.5, kMinOfWhole = 0.5;  // shares of medians
  Places telling;
  for (const SubjectPlace& place : places) {
    if (2 * place.solid >= place.cells.size()) telling.push_back(&place);
  }
  const double size = usual_size(telling), contrast = usual(telling, &SubjectPlace::contrast);
  erase_smaller(telling, kMinSize * size, false);
  std::erase_if(telling,
                [&](const SubjectPlace* place) { return place->contrast < kMinContrast * contrast; });
  const Places whole = whole_places(telling);
  if (!whole.empty()) erase_smaller(telling, kMinOfWhole * usual_size(whole), true);
  return telling;
}

Places whole_places(const Places& places) {
  Places whole = places;
  std::erase_if(whole, [](const SubjectPlace* place) { return place->is_cut_off; });
  return whole;
}

const SubjectPlace& last_large_place(const std::vector<SubjectPlace>& places) {
  constexpr double kMinSize = 0.5;  // of the median
  const Places telling = telling_places(places), all_whole = whole_places(telling);
  Places large = all_whole.empty() ? telling : all_whole;
  if (large.empty()) return places.back();
  erase_smaller(large, kMinSize * usual_size(large), false);
  return *large.back();
}

double distance(const Point& a, const Point& b) { return std::hypot(a.x - b.x, a.y - b.y); }

double furthest_apart(const Places& places) {
  const Places all_whole = whole_places(places);
  double furthest = 0;
  for (const SubjectPlace* whole : all_whole.empty() ? places : all_whole) {
    for (const SubjectPlace* other : places) {
      const double away = distance(whole->centre, other->centre);
      if (away > furthest && !share_a_cell(*whole, *other)) furthest = away;
    }
  }
  return furthest;
}

bool are_of_one_thing(const std::vector<SubjectPlace>& a, const std::vector<SubjectPlace>& b) {
  constexpr std::size_t kMinOfPlaces = 8;  // one of so many of what was seen less often
  std::size_t both = 0, same = 0;
  for (const SubjectPlace& place : a) {
    const auto other = std::ranges::lower_bound(b, place.sample, {}, &SubjectPlace::sample);
    if (other == b.end() || other->sample != place.sample) continue;
    ++both;
    if (share_a_cell(place, *other)) ++same;
  }
  return same > 0 && 2 * same >= both && kMinOfPlaces * same >= std::min(a.size(), b.size());
}

namespace {

// How many cells of a place another one touches or overlaps with when each is grown by half of so many cells.
double cells_near(const SubjectPlace& a, const SubjectPlace& b, std::size_t columns, std::size_t gap) {
  return static_cast<double>(std::ranges::count_if(a.cells, [&](std::size_t cell) {
    const std::size_t x = cell % columns, y = cell / columns;
    for (std::size_t row = y - std::min(y, gap); row <= y + gap; ++row) {
      const std::size_t first = row * columns + x - std::min(x, gap);
      const std::size_t last = row * columns + std::min(x + gap, columns - 1);
      const auto found = std::ranges::lower_bound(b.cells, first);
      if (found != b.cells.end() && *found <= last) return true;
    }
    return false;
  }));
}

// Adds those nearest to wishes that are spread evenly over candidates.
void add_evenly(const Places& candidates, std::uint32_t count, MomentSpacing spacing, const auto& is_free,
                Places& chosen) {
  std::vector<double> along{0};  // how far each candidate is along the way, or in time
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    const SubjectPlace &from = *candidates[i - 1], &to = *candidates[i];
    along.push_back(along.back() + (spacing == MomentSpacing::time ? static_cast<double>(to.sample - from.sample)
                                                                   : distance(from.centre, to.centre)));
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const double wanted = count == 1 ? along.back() / 2 : along.back() * i / (count - 1);
    // Within half of the way to the next wish.
    const double reach = count == 1 ? along.back() : along.back() / (2 * (count - 1));
    const SubjectPlace* best = nullptr;
    double best_away = reach;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const double away = std::abs(along[k] - wanted);
      if (away > best_away || (best != nullptr && away == best_away) || !is_free(*candidates[k])) continue;
      best = candidates[k];
      best_away = away;
    }
    if (best != nullptr) chosen.push_back(best);
  }
}

// Adds what there is room for beside those, the furthest first.
void add_others(const Places& candidates, std::uint32_t count, const auto& is_free, Places& chosen) {
  while (chosen.size() < count) {
    const SubjectPlace* best = nullptr;
    double furthest = -1;
    for (const SubjectPlace* candidate : candidates) {
      double nearest = HUGE_VAL;
      for (const SubjectPlace* other : chosen) {
        nearest = std::min(nearest, distance(candidate->centre, other->centre));
      }
      if (nearest <= furthest || !is_free(*candidate)) continue;
      furthest = nearest;
      best = candidate;
    }
    if (best == nullptr) return;
    chosen.push_back(best);
  }
}

}  // namespace

std::vector<SubjectPlace> choose_moments(const SubjectTrack& track, std::uint32_t count,
                                         MomentSpacing spacing, std::uint32_t gap_pixels,
                                         const std::vector<SubjectPlace>& taken) {
  constexpr double kMostHeld = 0.125;  // of the smaller: where a swing hangs
  const std::size_t gap_cells = gap_pixels == 0 ? 0 : (gap_pixels - 1) / track.cell_side + 1;
  Places chosen;
  double most_near = 0;  // cells, as a share of the smaller place
  const auto is_free = [&](const SubjectPlace& place) {
    const auto is_near = [&](const SubjectPlace& other) {
      const auto smaller = static_cast<double>(std::min(place.cells.size(), other.cells.size()));
      return cells_near(place, other, track.cell_columns, gap_cells) > most_near * smaller;
    };
    return std::ranges::none_of(chosen, [&](const SubjectPlace* other) { return is_near(*other); }) &&
           std::ranges::none_of(taken, is_near);
  };
  const Places candidates = telling_places(track.places);
  const Places whole = whole_places(candidates);
  const auto choose = [&](const Places& places) {
    if (!places.empty()) add_evenly(places, count, spacing, is_free, chosen);
    add_others(whole, count, is_free, chosen);
  };
  choose(whole.size() >= count ? whole : candidates);
  add_others(candidates, count, is_free, chosen);
  if (chosen.size() == 1 && count > 1 && whole.size() > 1) {
    const Places alone = std::exchange(chosen, {});
    most_near = kMostHeld;
    choose(whole);
    if (chosen.size() == 1) chosen = alone;
  }
  std::vector<SubjectPlace> moments;
  for (const SubjectPlace* each : chosen) moments.push_back(*each);
  std::ranges::sort(moments, {}, &SubjectPlace::sample);
  return moments;
}

}  // namespace nutik
