#include "scene/subject.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "capture/median.hpp"
#include "scene/differing_cells.hpp"
#include "scene/looks.hpp"
#include "scene/moments.hpp"

namespace nutik {
namespace {

constexpr double kMaxStir = 0.25;       // of its size: what moves by no more stays in its place

// The cells in which a subject is looked for, the last ones included.
struct Field {
  std::size_t left, top, right, bottom;
};

// The border of a box, in pixels.
std::uint32_t border_of(std::uint32_t cell_side) { return 2 * cell_side + 2; }

Places all_of(const std::vector<SubjectPlace>& places) {
  Places all;
  for (const SubjectPlace& place : places) all.push_back(&place);
  return all;
}

// What hangs together at one sample.
SubjectPlace place_of(std::vector<std::size_t> cells, std::uint64_t sample, const DifferingCells& differing,
                      std::uint32_t side, const Shape& shape, const Field& field) {
  const Region& grid = differing.region;
  SubjectPlace place;
  place.sample = sample;
  std::ranges::sort(cells);
  std::size_t left = grid.width, right = 0;
  double sum_x = 0, sum_y = 0;
  for (const std::size_t cell : cells) {
    const std::size_t x = cell % grid.width, y = cell / grid.width;
    left = std::min(left, x);
    right = std::max(right, x);
    sum_x += static_cast<double>(x) + 0.5;
    sum_y += static_cast<double>(y) + 0.5;
    place.contrast += differing.contrast[cell] / static_cast<double>(cells.size());
    place.solid += differing.solid.inside[cell];
  }
  const std::size_t top = cells.front() / grid.width, bottom = cells.back() / grid.width;
  place.is_cut_off = left == field.left || top == field.top || right == field.right || bottom == field.bottom;
  const auto count = static_cast<double>(cells.size());
  place.share = count / static_cast<double>(grid.pixel_count());
  place.fill = count / (static_cast<double>(right - left + 1) * static_cast<double>(bottom - top + 1));
  place.centre = {side * sum_x / count, side * sum_y / count};
  const auto pixels = [&](std::size_t cell) { return static_cast<std::uint32_t>(cell) * side; };
  const std::uint32_t border = border_of(side);
  place.box.x = pixels(left) - std::min(pixels(left), border);
  place.box.y = pixels(top) - std::min(pixels(top), border);
  place.box.width = std::min(pixels(right + 1) + border, shape.width) - place.box.x;
  place.box.height = std::min(pixels(bottom + 1) + border, shape.height) - place.box.y;
  place.cells = std::move(cells);
  return place;
}

// How far places lie apart, and how much steps from one to the next differ from those before them.
class Way {
 public:
  explicit Way(const std::vector<SubjectPlace>& places) {
    double left = HUGE_VAL, right = -HUGE_VAL, top = HUGE_VAL, bottom = -HUGE_VAL;
    Point step;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Point& centre = places[i].centre;
      left = std::min(left, centre.x);
      right = std::max(right, centre.x);
      top = std::min(top, centre.y);
      bottom = std::max(bottom, centre.y);
      if (i == 0) continue;
      const Point& before = places[i - 1].centre;
      const Point next{centre.x - before.x, centre.y - before.y};
      length_ += std::hypot(next.x, next.y);
      if (i > 1) turns_ += distance(next, step);
      step = next;
    }
    extent_ = places.empty() ? 0 : std::hypot(right - left, bottom - top);
  }

  [[nodiscard]] double extent() const { return extent_; }  // in pixels
  [[nodiscard]] double turns_of_extent() const { return extent_ > 0 ? turns_ / extent_ : 0; }
  // 0 of what goes straight on, 1.7 of places at random.
  [[nodiscard]] double turns_of_length() const { return length_ > 0 ? turns_ / length_ : 0; }

 private:
  double extent_ = 0, length_ = 0, turns_ = 0;
};

// Whether both cover the same cells, but for a share. Who walks past slowly stays near a place for a while, but covers
// other cells: legs part.
bool stays_at(const SubjectPlace& place, const SubjectPlace& later, double stir = kMaxStir) {
  const auto all = static_cast<double>(place.cells.size() + later.cells.size());
  return 2 * static_cast<double>(common_cells(place, later)) >= (1 - stir) * all;
}

// What was followed from one look to the next.
class Followed {
 public:
  Followed(SubjectPlace first, std::size_t look, std::uint32_t side)
      : side_(side), last_look_(look), last_trace_(look) {
    places_.push_back(std::move(first));
  }

  [[nodiscard]] bool is_lost(std::size_t look) const { return look > last_trace_ + kMaxLooksWithout; }
  [[nodiscard]] bool was_seen(std::size_t look) const { return last_trace_ == look; }
  // It is in what was seen then, but not alone.
  void hide(std::size_t look) { last_trace_ = look; }

  // How unlike a place is to what would be seen of this now, going on as it did: how far off it lies, in its own sizes,
  // and how often it would have doubled.
  [[nodiscard]] double strays(const SubjectPlace& place, std::size_t look) const {
    const SubjectPlace& last = places_.back();
    const Point expected = expected_at(look);
    const auto before = static_cast<double>(last.cells.size()), now = static_cast<double>(place.cells.size());
    const double size = side_ * std::sqrt(std::max(before, now));
    return std::min(distance(expected, place.centre), distance(last.centre, place.centre)) / size +
           std::abs(std::log2(now / before));
  }

  // Whether the place holds most of what would be seen of this now.
  [[nodiscard]] bool is_within(const SubjectPlace& place, std::size_t look, std::size_t columns) const {
    const SubjectPlace& last = places_.back();
    const Point expected = expected_at(look);
    const long right = std::lround((expected.x - last.centre.x) / side_);
    const long down = std::lround((expected.y - last.centre.y) / side_);
    const auto width = static_cast<long>(columns);
    const auto held = std::ranges::count_if(last.cells, [&](std::size_t cell) {
      const long x = static_cast<long>(cell % columns) + right, y = static_cast<long>(cell / columns) + down;
      return x >= 0 && x < width && y >= 0 &&
             std::ranges::binary_search(place.cells, static_cast<std::size_t>(y * width + x));
    });
    return 2 * static_cast<std::size_t>(held) > last.cells.size();
  }

  // Two things, and no pieces of one: both were seen further apart than they are long.
  [[nodiscard]] bool met(const Followed& other) const {
    if (places_.size() < kMinPlaces || other.places_.size() < kMinPlaces) return false;
    const auto length = [](const SubjectPlace& place) { return std::max(place.box.width, place.box.height); };
    return std::ranges::any_of(places_, [&](const SubjectPlace& place) {
      const auto same = std::ranges::lower_bound(other.places_, place.sample, {}, &SubjectPlace::sample);
      return same != other.places_.end() && same->sample == place.sample &&
             distance(place.centre, same->centre) > length(place) + length(*same);
    });
  }

  // Whether it is still where it was first seen, as a hole is where the plate has a thing, and so the place is another
  // thing's. Who passes may have hung together with it for a while.
  [[nodiscard]] bool stays_beside(const SubjectPlace& place, const std::vector<SubjectPlace>& places) const {
    constexpr double kNoise = 0.1;  // of its cells
    if (places_.size() < kMinPlaces || stays_at(places_.back(), place)) return false;
    if (2 * common_cells(places_.front(), places_.back()) < places_.front().cells.size()) return false;
    return std::ranges::any_of(places, [&](const SubjectPlace& other) {
      return &other != &place && stays_at(places_.front(), other, kNoise);
    });
  }

  [[nodiscard]] std::size_t cells() const { return places_.back().cells.size(); }

  void add(SubjectPlace place, std::size_t look) {
    last_step_ = look - last_look_;
    last_look_ = last_trace_ = look;
    places_.push_back(std::move(place));
  }

  // How far it goes, in a measure that lets a small thing that crosses the picture win over a large one that stirs, a
  // thing over its shadow, one that goes its way over what flickers here and there, one that can be shown twice and is
  // mostly seen as a whole over one that is not, and most of what differs over a piece of it.
  [[nodiscard]] double weight() const {
    constexpr double kAtOnePlace = 0.125, kCutOff = 0.25;
    double cells = 0, contrast = 0, share = 0, whole = 0;
    for (const SubjectPlace& place : places_) {
      if (!place.is_cut_off) ++whole;
      cells += static_cast<double>(place.cells.size());
      contrast += place.contrast;
      share += place.share;
    }
    const auto count = static_cast<double>(places_.size());
    const Way way(places_);
    const double apart = stays() ? 0 : furthest_apart(telling_places(places_));
    const double extent = std::max(apart, kAtOnePlace * way.extent());
    return extent * std::lerp(kCutOff, 1.0, whole / count) * std::pow(cells / count * share / count, 0.25) *
           contrast / count / (1 + way.turns_of_extent());
  }

  // And can be shown twice.
  [[nodiscard]] bool goes_its_way() const {
    constexpr double kMaxTurns = 1;
    return places_.size() >= kMinPlaces && furthest_apart(telling_places(places_)) > 0 &&
           Way(places_).turns_of_length() < kMaxTurns;
  }
  [[nodiscard]] bool is_beside(const Followed& other) const {
    const auto both = std::ranges::count_if(places_, [&](const SubjectPlace& place) {
      return std::ranges::binary_search(other.places_, place.sample, {}, &SubjectPlace::sample);
    });
    return 2 * static_cast<std::size_t>(both) >= places_.size();
  }

  [[nodiscard]] std::vector<SubjectPlace>&& places() && { return std::move(places_); }

 private:
  static constexpr std::size_t kMaxLooksWithout = 3;
  static constexpr std::size_t kMinPlaces = 4;  // fewer are no way

  // Where the plate shows a thing that was taken away, a hole stays, and what passes there is followed with it: nearly
  // all of its places are one, and those elsewhere are too few for a way.
  [[nodiscard]] bool stays() const {
    std::vector<double> x, y, cells;
    for (const SubjectPlace& place : places_) {
      x.push_back(place.centre.x);
      y.push_back(place.centre.y);
      cells.push_back(static_cast<double>(place.cells.size()));
    }
    const Point middle{median(std::move(x)), median(std::move(y))};
    const double reach = kMaxStir * side_ * std::sqrt(median(std::move(cells)));
    const auto elsewhere = static_cast<std::size_t>(std::ranges::count_if(
        places_, [&](const SubjectPlace& place) { return distance(place.centre, middle) > reach; }));
    return elsewhere < kMinPlaces && 2 * elsewhere < places_.size();
  }

  // Going on as it did.
  [[nodiscard]] Point expected_at(std::size_t look) const {
    Point expected = places_.back().centre;
    if (places_.size() == 1) return expected;
    const auto looks = static_cast<double>(look - last_look_) / static_cast<double>(last_step_);
    const Point &last = places_.back().centre, &earlier = places_[places_.size() - 2].centre;
    expected.x += looks * (last.x - earlier.x);
    expected.y += looks * (last.y - earlier.y);
    return expected;
  }

  std::uint32_t side_;  // of cells, in pixels
  std::vector<SubjectPlace> places_;
  std::size_t last_look_, last_trace_, last_step_ = 1;
};

// Follows everything that is not the plate's.
class Follower {
 public:
  Follower(const Shape& shape, std::uint32_t side, const Field& field)
      : shape_(shape), side_(side), field_(field) {}

  // What differs at the next look.
  void add(const DifferingCells& cells, std::uint64_t sample) {
    std::vector<SubjectPlace> places;
    for (std::vector<std::size_t>& part : parts_of(cells.region, kMinCells)) {
      if (places.size() == kMaxParts) break;
      places.push_back(place_of(std::move(part), sample, cells, side_, shape_, field_));
    }
    std::erase_if(places, [&](const SubjectPlace& place) { return hides_several(place, cells.region.width); });
    for (const SubjectPlace& place : places) {
      Followed* nearest = nullptr;
      double least = kMaxStray;
      for (Followed& each : followed_) {
        if (each.is_lost(look_) || each.was_seen(look_)) continue;
        const double strays = each.strays(place, look_);
        if (strays > least || each.stays_beside(place, places)) continue;
        least = strays;
        nearest = &each;
      }
      if (nearest != nullptr) {
        nearest->add(place, look_);
      } else {
        followed_.emplace_back(place, look_, side_);
      }
    }
    ++look_;
  }

  // What goes furthest, and what goes half as far or more: `beside` it for half of its own time, as one whole thing, or
  // `instead` of it: a few of these at most. And what else goes its way, not so far.
  struct Subjects {
    std::vector<SubjectPlace> first;
    std::vector<std::vector<SubjectPlace>> beside, instead, lesser;
  };
  [[nodiscard]] Subjects subjects() && {
    constexpr std::size_t kMaxSubjects = 4;
    constexpr double kMinLesser = 0.125;
    std::vector<std::pair<double, Followed*>> by_weight;
    for (Followed& each : followed_) by_weight.emplace_back(each.weight(), &each);
    if (by_weight.empty()) return {};
    std::ranges::stable_sort(by_weight, std::ranges::greater(), &std::pair<double, Followed*>::first);
    const auto [most, subject] = by_weight.front();
    Subjects found;
    for (const auto& [weight, other] : std::span(by_weight).subspan(1)) {
      if (weight <= 0 || weight < kMinLesser * most) break;
      const bool goes_its_way = other->goes_its_way();
      if (weight < most / 2 || 1 + found.beside.size() + found.instead.size() == kMaxSubjects) {
        if (goes_its_way) found.lesser.push_back(std::move(*other).places());
        continue;
      }
      const bool is_beside = goes_its_way && other->is_beside(*subject);
      (is_beside ? found.beside : found.instead).push_back(std::move(*other).places());
    }
    found.first = std::move(*subject).places();
    return found;
  }

 private:
  static constexpr std::size_t kMaxParts = 12;
  static constexpr double kMaxStray = 4;
  static constexpr std::size_t kMinPart = 16;  // one of so many parts of what hangs together is no scrap

  // Things that meet hang together until they part: that is no place of any of them.
  bool hides_several(const SubjectPlace& place, std::size_t columns) {
    std::vector<Followed*> within;
    for (Followed& each : followed_) {
      if (each.is_lost(look_) || kMinPart * each.cells() < place.cells.size()) continue;
      if (each.is_within(place, look_, columns)) within.push_back(&each);
    }
    bool hides = false;
    for (std::size_t i = 0; i < within.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        if (!within[i]->met(*within[k])) continue;
        within[i]->hide(look_);
        within[k]->hide(look_);
        hides = true;
      }
    }
    return hides;
  }

  Shape shape_;
  std::uint32_t side_;
  Field field_;
  std::size_t look_ = 0;
  std::vector<Followed> followed_;
};

// From one place that it stays at to the last there. None where hardly anything would be left of its way.
std::vector<SampleRange> rests_of(const std::vector<SubjectPlace>& places) {
  constexpr std::uint64_t kMinLooks = 4;
  constexpr std::uint64_t kMinOfWay = 8;  // one of so many parts of the time
  std::vector<SampleRange> rests;
  if (places.empty()) return rests;
  const std::uint64_t way = places.back().sample - places.front().sample + 1;
  std::uint64_t resting = 0;
  for (std::size_t first = 0, last = 0; first < places.size(); first = last + 1) {
    last = first;
    while (last + 1 < places.size() && stays_at(places[first], places[last + 1])) ++last;
    const SampleRange rest{places[first].sample, places[last].sample + 1};
    if (last - first + 1 < kMinLooks || kMinOfWay * rest.size() < way) continue;
    // As one where it only shifted.
    if (!rests.empty() && first > 0 && rests.back().last == places[first - 1].sample + 1) {
      rests.back().last = rest.last;
    } else {
      rests.push_back(rest);
    }
  }
  for (const SampleRange& rest : rests) resting += rest.size();
  if (kMinOfWay * (way - resting) < way) rests.clear();
  return rests;
}

// Finds the subject of a region.
class Tracker {
 public:
  Tracker(const Shape& shape, std::uint32_t side, const Rectangle& region, std::uint64_t looks)
      : field_{region.x / side, region.y / side, (region.x + region.width - 1) / side,
               (region.y + region.height - 1) / side},
        follower_(shape, side, field_),
        looks_(looks) {
    track_.cell_side = side;
    track_.differing = std::make_shared<std::vector<std::vector<bool>>>();
  }

  void add(const DifferingCells& all, std::uint64_t sample) {
    const std::uint32_t columns = all.region.width;
    DifferingCells cells{Region::none(columns, all.region.height), all.solid, all.contrast};
    for (std::size_t row = field_.top; row <= field_.bottom; ++row) {
      const auto first = static_cast<std::ptrdiff_t>(row * columns + field_.left);
      std::copy_n(all.region.inside.begin() + first, field_.right - field_.left + 1,
                  cells.region.inside.begin() + first);
    }
    track_.looked_at.push_back(sample);
    track_.differing->emplace_back(all.region.inside.begin(), all.region.inside.end());
    track_.cell_columns = columns;
    const std::uint64_t differing = cells.region.pixel_count();
    track_.moving_share +=
        static_cast<double>(differing) /
        (static_cast<double>(field_.right - field_.left + 1) *
         static_cast<double>(field_.bottom - field_.top + 1) * static_cast<double>(looks_));
    without_ = all.region.pixel_count() >= kMinCells
                   ? SampleRange()
                   : SampleRange{without_.empty() ? sample : without_.first, sample + 1};
    if (without_.size() > track_.empty.size()) track_.empty = without_;
    follower_.add(cells, sample);
  }

  [[nodiscard]] SubjectTrack track() && {
    const SubjectTrack none = track_;
    Follower::Subjects subjects = std::move(follower_).subjects();
    const auto track_of = [&](std::vector<SubjectPlace>& places) {
      SubjectTrack track = none;
      track.places = std::move(places);
      measure(track);
      return track;
    };
    SubjectTrack track = track_of(subjects.first);
    std::ranges::transform(subjects.beside, std::back_inserter(track.others), track_of);
    std::ranges::transform(subjects.instead, std::back_inserter(track.instead), track_of);
    std::ranges::transform(subjects.lesser, std::back_inserter(track.lesser), track_of);
    return track;
  }

 private:
  // What is followed on where the thing has left the picture, or was before it came, is no part of its way.
  static void trim(std::vector<SubjectPlace>& places) {
    const Places telling = telling_places(places);
    const auto is_seen = [&](const SubjectPlace& place) {
      return place.is_cut_off || std::ranges::binary_search(telling, &place);
    };
    const auto first = std::ranges::find_if(places, is_seen);
    const auto last = std::ranges::find_if(places.rbegin(), std::make_reverse_iterator(first), is_seen).base();
    places.erase(last, places.end());
    places.erase(places.begin(), first);
  }

  static void measure(SubjectTrack& track) {
    trim(track.places);
    track.rests = rests_of(track.places);
    const Way way(track.places);
    track.extent = way.extent();
    // A pendulum turns often on its long way; who stands for a while stirs, and yet goes somewhere.
    constexpr double kMaxTurnsOfLength = 1.3, kMaxTurnsOfExtent = 2;
    track.fill = usual(all_of(track.places), &SubjectPlace::fill);
    track.share = usual(all_of(track.places), &SubjectPlace::share);
    track.flickers = way.turns_of_length() > kMaxTurnsOfLength && way.turns_of_extent() > kMaxTurnsOfExtent;
  }

  Field field_;
  Follower follower_;
  std::uint64_t looks_;
  SampleRange without_;  // anything, up to now
  SubjectTrack track_;
};

}  // namespace

std::size_t common_cells(const SubjectPlace& place, const SubjectPlace& other) {
  std::vector<std::size_t> both;
  std::ranges::set_intersection(place.cells, other.cells, std::back_inserter(both));
  return both.size();
}

double min_misplaced_pixels(const Shape& shape) { return Difference::side(shape) / 2.0; }

double SubjectTrack::size() const {
  return cell_side * std::sqrt(usual(all_of(places), [](const SubjectPlace& place) {
           return static_cast<double>(place.cells.size());
         }));
}

double SubjectTrack::length() const {
  return usual(all_of(places), [&](const SubjectPlace& place) {
    return std::max(place.box.width, place.box.height) - 2.0 * border_of(cell_side);
  });
}

double SubjectTrack::covered_share() const {
  const auto counts = [&](std::uint64_t sample) {
    return sample >= places.front().sample && sample <= places.back().sample &&
           std::ranges::none_of(rests,
                                [&](SampleRange rest) { return rest.first <= sample && sample < rest.last; });
  };
  std::vector<std::size_t> swept;
  std::size_t sum = 0;
  for (const SubjectPlace& place : places) {
    if (!counts(place.sample)) continue;
    sum += place.cells.size();
    std::vector<std::size_t> joined;
    std::ranges::set_union(swept, place.cells, std::back_inserter(joined));
    swept = std::move(joined);
  }
  if (swept.empty()) return 0;
  const auto looks = std::ranges::count_if(looked_at, counts);
  return static_cast<double>(sum) / (static_cast<double>(swept.size()) * static_cast<double>(looks));
}

double SubjectTrack::most_covered_share() const {
  std::vector<std::size_t> counts;
  for (const SubjectPlace& place : places) {
    if (place.cells.empty()) continue;
    if (counts.size() <= place.cells.back()) counts.resize(place.cells.back() + 1);
    for (const std::size_t cell : place.cells) ++counts[cell];
  }
  if (counts.empty()) return 0;
  return static_cast<double>(std::ranges::max(counts)) / static_cast<double>(looked_at.size());
}

std::vector<std::vector<std::size_t>> SubjectTrack::changed_for_good() const {
  if (differing->empty()) return {};
  const std::size_t all = differing->front().size();
  std::vector<std::size_t> counts(all);
  std::size_t looks = 0;
  for (std::size_t look = 0; look < looked_at.size(); ++look) {
    const std::uint64_t sample = looked_at[look];
    const bool is_resting = std::ranges::any_of(
        rests, [&](SampleRange rest) { return rest.first <= sample && sample < rest.last; });
    if (is_resting || !std::ranges::binary_search(places, sample, {}, &SubjectPlace::sample)) continue;
    ++looks;
    for (std::size_t cell = 0; cell < all; ++cell) counts[cell] += (*differing)[look][cell] ? 1 : 0;
  }
  Region changed = Region::none(cell_columns, static_cast<std::uint32_t>(all / cell_columns));
  for (std::size_t cell = 0; cell < all; ++cell) changed.inside[cell] = 4 * counts[cell] > 3 * looks ? 1 : 0;
  return parts_of(changed, kMinCells);
}

SubjectTrack::BareGround SubjectTrack::bare_ground(const SubjectPlace& place, std::uint32_t pixels) const {
  constexpr std::size_t kLongEnough = 8;  // looks: the average of more has hardly less noise
  const std::size_t around = (pixels + cell_side - 1) / cell_side;
  std::vector<bool> is_of_place(differing->front().size());
  for (const std::size_t cell : place.cells) {
    const std::size_t x = cell % cell_columns, y = cell / cell_columns;
    for (std::size_t row = y - std::min(y, around); row <= y + around; ++row) {
      for (std::size_t column = x - std::min(x, around); column <= std::min(x + around, cell_columns - std::size_t{1});
           ++column) {
        const std::size_t near = row * cell_columns + column;
        if (near < is_of_place.size()) is_of_place[near] = true;
      }
    }
  }
  std::vector<std::size_t> cells;
  for (std::size_t cell = 0; cell < is_of_place.size(); ++cell) {
    if (!is_of_place[cell]) continue;
    if (std::ranges::binary_search(bare, cell)) return {};
    cells.push_back(cell);
  }
  const auto is_free = [&](std::size_t look) {
    return std::ranges::none_of(cells, [&](std::size_t cell) { return (*differing)[look][cell]; });
  };
  BareGround ground;
  for (std::size_t first = 0, last = 0; first < looked_at.size(); first = last + 1) {
    for (last = first; last < looked_at.size() && last < first + kLongEnough && is_free(last);) ++last;
    if (first < last) ground.times.push_back({looked_at[first], looked_at[last - 1] + 1});
  }
  const auto away = [&](SampleRange time) {
    return time.first > place.sample ? time.first - place.sample : place.sample - time.last;
  };
  std::ranges::stable_sort(ground.times, {}, away);
  std::ranges::stable_sort(ground.times, std::ranges::greater(), &SampleRange::size);
  const auto look = static_cast<std::size_t>(std::ranges::lower_bound(looked_at, place.sample) - looked_at.begin());
  std::erase_if(cells, [&](std::size_t cell) { return (*differing)[look][cell]; });
  ground.cells = std::move(cells);
  return ground;
}

std::vector<SubjectTrack> track_subjects(CaptureSource& capture, const Picture& plate, std::uint32_t by_codes,
                                         const std::vector<Rectangle>& regions,
                                         const ReportedProgress& progress) {
  const CaptureFormat& format = capture.format();
  const Looks looks(capture.timeline().sample_count());
  Difference difference(format, plate, by_codes);
  std::vector<Tracker> trackers;
  for (const Rectangle& region : regions) {
    trackers.emplace_back(format.shape, Difference::side(format.shape), region, looks.count());
  }
  for_each_look(capture, looks, [&](const Look& look) {
    if (progress) progress(look.number, looks.count());
    const DifferingCells& cells = difference.at(look);
    for (Tracker& tracker : trackers) tracker.add(cells, looks.sample(look.number));
  });
  std::vector<SubjectTrack> tracks;
  for (Tracker& tracker : trackers) tracks.push_back(std::move(tracker).track());
  return tracks;
}

}  // namespace nutik
