#include "scene/telling_places.hpp"

#include <algorithm>
#include <cmath>

namespace nutik {
namespace {

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

double median_size(const Places& places) {
  std::vector<double> sizes;
  for (const SubjectPlace* place : places) sizes.push_back(static_cast<double>(place->cells.size()));
  return median_of(std::move(sizes));
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

Places telling_places(const std::vector<SubjectPlace>& places) {
  constexpr double kMinSize = 0.25, kMinContrast = 0.5, kMinOfWhole = 0.5;  // shares of medians
  Places telling;
  std::vector<double> contrasts;
  for (const SubjectPlace& place : places) {
    telling.push_back(&place);
    contrasts.push_back(place.contrast);
  }
  if (telling.empty()) return telling;
  const double size = median_size(telling), contrast = median_of(std::move(contrasts));
  erase_smaller(telling, kMinSize * size, false);
  std::erase_if(telling,
                [&](const SubjectPlace* place) { return place->contrast < kMinContrast * contrast; });
  const Places whole = whole_places(telling);
  if (!whole.empty()) erase_smaller(telling, kMinOfWhole * median_size(whole), true);
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
  erase_smaller(large, kMinSize * median_size(large), false);
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

}  // namespace nutik
