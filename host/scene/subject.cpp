#include "scene/subject.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <utility>

#include "imev/each_block.hpp"

namespace nutik {
namespace {

constexpr std::uint64_t kMostLookedAt = 256;
constexpr std::uint32_t kMostCellsToASide = 480;
constexpr std::uint32_t kGapPixels = 8;   // between moments: for the soft borders of both
constexpr std::uint64_t kLeastCells = 6;  // fewer are noise

// Which cells differ from the plate, in half of their pixels or more.
class Difference {
 public:
  Difference(const CaptureFormat& capture, const Picture& plate, std::uint32_t by_codes)
      : capture_(capture),
        plate_(plate),
        by_codes_(by_codes),
        side_((std::max(capture.shape.width, capture.shape.height) - 1) / kMostCellsToASide + 1),
        columns_((capture.shape.width + side_ - 1) / side_),
        rows_((capture.shape.height + side_ - 1) / side_) {}

  [[nodiscard]] std::uint32_t side() const { return side_; }

  [[nodiscard]] Region cells(std::span<const std::byte> raster) const {
    return capture_.code_bytes == 1 ? cells(reinterpret_cast<const std::uint8_t*>(raster.data()))
                                    : cells(reinterpret_cast<const std::uint16_t*>(raster.data()));
  }

 private:
  template <typename Code>
  [[nodiscard]] Region cells(const Code* codes) const {
    const auto [width, height, channels] = capture_.shape;
    const Code* plate = plate_.values<Code>().data();
    std::vector<std::uint32_t> counts(std::size_t{columns_} * rows_);
    for (std::uint32_t y = 0; y < height; ++y) {
      std::uint32_t* const row = counts.data() + std::size_t{y / side_} * columns_;
      for (std::uint32_t x = 0; x < width; ++x) {
        bool differs = false;
        for (std::uint32_t channel = 0; channel < channels; ++channel, ++codes, ++plate) {
          differs |= static_cast<std::uint32_t>(std::abs(int{*codes} - int{*plate})) > by_codes_;
        }
        row[x / side_] += differs ? 1 : 0;
      }
    }
    Region region = Region::none(columns_, rows_);
    for (std::uint32_t row = 0; row < rows_; ++row) {
      const std::uint32_t high = std::min(side_, height - row * side_);
      for (std::uint32_t column = 0; column < columns_; ++column) {
        const std::uint32_t wide = std::min(side_, width - column * side_);
        const std::size_t cell = std::size_t{row} * columns_ + column;
        region.inside[cell] = 2 * counts[cell] >= wide * high;
      }
    }
    return region;
  }

  const CaptureFormat& capture_;
  const Picture& plate_;
  std::uint32_t by_codes_, side_, columns_, rows_;
};

// What hangs together at one sample.
SubjectPlace place_of(std::vector<std::size_t> cells, std::uint64_t sample, const Region& grid,
                      std::uint32_t side, const Shape& shape) {
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
  }
  const std::size_t top = cells.front() / grid.width, bottom = cells.back() / grid.width;
  place.is_cut_off = left == 0 || top == 0 || right + 1 == grid.width || bottom + 1 == grid.height;
  const auto count = static_cast<double>(cells.size());
  place.centre = {side * sum_x / count, side * sum_y / count};
  const auto pixels = [&](std::size_t cell) { return static_cast<std::uint32_t>(cell) * side; };
  const std::uint32_t border = 2 * side + 2;
  place.box.x = pixels(left) - std::min(pixels(left), border);
  place.box.y = pixels(top) - std::min(pixels(top), border);
  place.box.width = std::min(pixels(right + 1) + border, shape.width) - place.box.x;
  place.box.height = std::min(pixels(bottom + 1) + border, shape.height) - place.box.y;
  place.cells = std::move(cells);
  return place;
}

double distance(const Point& a, const Point& b) { return std::hypot(a.x - b.x, a.y - b.y); }

// What was followed from one look to the next.
class Followed {
 public:
  Followed(SubjectPlace first, std::size_t look) : last_look_(look) { places_.push_back(std::move(first)); }

  [[nodiscard]] bool is_lost(std::size_t look) const { return look > last_look_ + kMostLooksWithout; }
  [[nodiscard]] bool was_seen(std::size_t look) const { return last_look_ == look; }

  // How far a place is from where this would be now, going on as it did; in its own sizes.
  [[nodiscard]] double strays(const SubjectPlace& place, std::size_t look, std::uint32_t side) const {
    const SubjectPlace& last = places_.back();
    Point expected = last.centre;
    if (places_.size() > 1) {
      const auto looks = static_cast<double>(look - last_look_) / static_cast<double>(last_step_);
      const Point& before = places_[places_.size() - 2].centre;
      expected.x += looks * (last.centre.x - before.x);
      expected.y += looks * (last.centre.y - before.y);
    }
    const double size =
        side * std::sqrt(static_cast<double>(std::max(last.cells.size(), place.cells.size())));
    return std::min(distance(expected, place.centre), distance(last.centre, place.centre)) / size;
  }

  void add(SubjectPlace place, std::size_t look) {
    last_step_ = look - last_look_;
    last_look_ = look;
    places_.push_back(std::move(place));
  }

  // How far it goes, in a measure that lets a small thing that crosses the picture win over a large one that stirs.
  [[nodiscard]] double weight() const {
    double left = HUGE_VAL, right = -HUGE_VAL, top = HUGE_VAL, bottom = -HUGE_VAL, cells = 0;
    for (const SubjectPlace& place : places_) {
      left = std::min(left, place.centre.x);
      right = std::max(right, place.centre.x);
      top = std::min(top, place.centre.y);
      bottom = std::max(bottom, place.centre.y);
      cells += static_cast<double>(place.cells.size());
    }
    return std::hypot(right - left, bottom - top) *
           std::pow(cells / static_cast<double>(places_.size()), 0.25);
  }

  [[nodiscard]] std::vector<SubjectPlace>&& places() && { return std::move(places_); }

 private:
  static constexpr std::size_t kMostLooksWithout = 3;

  std::vector<SubjectPlace> places_;
  std::size_t last_look_, last_step_ = 1;
};

// Follows everything that is not the plate's.
class Follower {
 public:
  Follower(const Shape& shape, std::uint32_t side) : shape_(shape), side_(side) {}

  // What differs at the next look.
  void add(const Region& cells, std::uint64_t sample) {
    std::vector<SubjectPlace> places;
    for (std::vector<std::size_t>& part : parts_of(cells, kLeastCells)) {
      if (places.size() == kMostParts) break;
      places.push_back(place_of(std::move(part), sample, cells, side_, shape_));
    }
    for (SubjectPlace& place : places) {
      Followed* nearest = nullptr;
      double least = kMostStray;
      for (Followed& each : followed_) {
        if (each.is_lost(look_) || each.was_seen(look_)) continue;
        const double strays = each.strays(place, look_, side_);
        if (strays > least) continue;
        least = strays;
        nearest = &each;
      }
      if (nearest != nullptr) {
        nearest->add(std::move(place), look_);
      } else {
        followed_.emplace_back(std::move(place), look_);
      }
    }
    ++look_;
  }

  [[nodiscard]] std::vector<SubjectPlace> subject() && {
    if (followed_.empty()) return {};
    return std::move(*std::ranges::max_element(followed_, {}, &Followed::weight)).places();
  }

 private:
  static constexpr std::size_t kMostParts = 12;
  static constexpr double kMostStray = 4;  // sizes

  Shape shape_;
  std::uint32_t side_;
  std::size_t look_ = 0;
  std::vector<Followed> followed_;
};

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

}  // namespace

double SubjectTrack::covered_share() const {
  if (places.empty()) return 0;
  std::vector<std::size_t> swept;
  std::size_t sum = 0;
  for (const SubjectPlace& place : places) {
    sum += place.cells.size();
    std::vector<std::size_t> joined;
    std::ranges::set_union(swept, place.cells, std::back_inserter(joined));
    swept = std::move(joined);
  }
  const auto looks = std::ranges::count_if(looked_at, [&](std::uint64_t sample) {
    return sample >= places.front().sample && sample <= places.back().sample;
  });
  return static_cast<double>(sum) / (static_cast<double>(swept.size()) * static_cast<double>(looks));
}

SubjectTrack track_subject(CaptureSource& capture, const Picture& plate, std::uint32_t by_codes,
                           const std::function<void(std::uint64_t, std::uint64_t)>& progress) {
  const CaptureFormat& format = capture.format();
  const std::uint64_t count = capture.timeline().sample_count();
  const std::uint64_t looks = std::min(count, kMostLookedAt);
  const Difference difference(format, plate, by_codes);
  Follower follower(format.shape, difference.side());
  SubjectTrack track;
  for (std::uint64_t i = 0; i < looks; ++i) track.looked_at.push_back(i * count / looks);
  track.cell_side = difference.side();
  std::vector<std::byte> raster(format.sample_bytes());
  SampleRange stretch;  // without anything, up to now
  auto next = track.looked_at.begin();
  for_each_block(capture, [&](const BlockView& block) {
    for (; next != track.looked_at.end() && *next < block.extent().range().last; ++next) {
      if (progress) progress(static_cast<std::uint64_t>(next - track.looked_at.begin()), looks);
      block.read_sample(static_cast<std::uint32_t>(*next - block.extent().first_sample), raster);
      const Region cells = difference.cells(raster);
      track.cell_columns = cells.width;
      const std::uint64_t differing = cells.pixel_count();
      track.moving_share += static_cast<double>(differing) /
                            (static_cast<double>(cells.inside.size()) * static_cast<double>(looks));
      stretch = differing >= kLeastCells ? SampleRange()
                                         : SampleRange{stretch.empty() ? *next : stretch.first, *next + 1};
      if (stretch.size() > track.empty.size()) track.empty = stretch;
      follower.add(cells, *next);
    }
  });
  track.places = std::move(follower).subject();
  return track;
}

namespace {

// Those that are no mere piece of the subject, of which the rest looks like what is behind it.
std::vector<const SubjectPlace*> large_places(const SubjectTrack& track) {
  constexpr std::size_t kLeastShare = 4;  // of its usual size
  std::vector<std::size_t> sizes;
  for (const SubjectPlace& place : track.places) sizes.push_back(place.cells.size());
  if (sizes.empty()) return {};
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::ranges::nth_element(sizes, middle);
  std::vector<const SubjectPlace*> large;
  for (const SubjectPlace& place : track.places) {
    if (kLeastShare * place.cells.size() >= *middle) large.push_back(&place);
  }
  return large;
}

}  // namespace

std::vector<SubjectPlace> choose_moments(const SubjectTrack& track, std::uint32_t count,
                                         MomentSpacing spacing) {
  std::vector<const SubjectPlace*> candidates = large_places(track);
  const auto is_cut_off = [](const SubjectPlace* place) { return place->is_cut_off; };
  const auto whole = static_cast<std::uint64_t>(std::ranges::count_if(candidates, std::not_fn(is_cut_off)));
  if (whole >= count) std::erase_if(candidates, is_cut_off);
  if (candidates.empty()) return {};
  // How far each candidate is along the way, or in time.
  std::vector<double> along{0};
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    const SubjectPlace &from = *candidates[i - 1], &to = *candidates[i];
    along.push_back(along.back() + (spacing == MomentSpacing::time
                                        ? static_cast<double>(to.sample - from.sample)
                                        : distance(from.centre, to.centre)));
  }
  const std::size_t gap = (kGapPixels - 1) / track.cell_side + 1;
  std::vector<const SubjectPlace*> chosen;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double wanted = count == 1 ? along.back() / 2 : along.back() * i / (count - 1);
    // The nearest that overlaps with none so far, within half of the way to the next wish.
    const double reach = count == 1 ? along.back() : along.back() / (2 * (count - 1));
    const SubjectPlace* best = nullptr;
    double best_away = reach;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const double away = std::abs(along[k] - wanted);
      if (away > best_away || (best != nullptr && away == best_away)) continue;
      if (std::ranges::any_of(chosen, [&](const SubjectPlace* other) {
            return overlap(*candidates[k], *other, track.cell_columns, gap);
          })) {
        continue;
      }
      best = candidates[k];
      best_away = away;
    }
    if (best != nullptr) chosen.push_back(best);
  }
  std::ranges::sort(chosen, {}, &SubjectPlace::sample);
  std::vector<SubjectPlace> moments;
  for (const SubjectPlace* each : chosen) moments.push_back(*each);
  return moments;
}

}  // namespace nutik
