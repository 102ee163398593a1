#include "features/study/study_regions.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "features/masks/mask_making.hpp"
#include "session/requests/stated_moments.hpp"

namespace nutik {
namespace {

// In pixels: without specks and without holes.
constexpr double kSmoothRadius = 1, kCloseRadius = 7;
// The least share of its subject's cells. A drawn bag is 1/6 of who carries it; less is often light at an edge.
constexpr double kMinExchanged = 1.0 / 16;

// Whether a region within a box lies at its border.
bool reaches_border(const Mask& mask, const select::Rectangle& box) {
  for (std::size_t pixel = 0; pixel < mask.tags.size(); ++pixel) {
    if (mask.tags[pixel] == 0) continue;
    const auto x = static_cast<double>(pixel % mask.width), y = static_cast<double>(pixel / mask.width);
    if (x < box.corner.x + 1 || y < box.corner.y + 1 || x >= box.corner.x + box.width - 1 ||
        y >= box.corner.y + box.height - 1) {
      return true;
    }
  }
  return false;
}

// Each what hangs together, increasing.
std::vector<std::vector<std::size_t>> exchanged_cells(const SubjectTrack& track, std::size_t before, std::size_t after,
                                                      std::size_t looks) {
  const auto differs_throughout = [&](std::size_t from, std::size_t cell, bool differs) {
    const auto first = track.differing->begin() + static_cast<std::ptrdiff_t>(from);
    return std::all_of(first, first + static_cast<std::ptrdiff_t>(looks),
                       [&](const std::vector<bool>& cells) { return cells[cell] == differs; });
  };
  const std::size_t all = track.differing->front().size();
  Region changed = Region::none(track.cell_columns, static_cast<std::uint32_t>(all / track.cell_columns));
  for (std::size_t cell = 0; cell < all; ++cell) {
    const bool differed = (*track.differing)[before][cell];
    const bool is_other = differs_throughout(before, cell, differed) && differs_throughout(after, cell, !differed);
    changed.inside[cell] = is_other ? 1 : 0;
  }
  std::vector<std::vector<std::size_t>> parts = parts_of(changed, kMinCells);
  for (std::vector<std::size_t>& part : parts) std::ranges::sort(part);
  return parts;
}

}  // namespace

bool touches(const SubjectPlace& place, const std::vector<std::size_t>& cells, std::size_t columns) {
  const auto is_one = [&](std::size_t cell) { return std::ranges::binary_search(cells, cell); };
  return std::ranges::any_of(place.cells, [&](std::size_t cell) {
    return is_one(cell) || is_one(cell - 1) || is_one(cell + 1) || is_one(cell - columns) || is_one(cell + columns);
  });
}

select::Rectangle box_round(const std::vector<std::size_t>& cells, const SubjectTrack& track) {
  double left = HUGE_VAL, top = HUGE_VAL, right = 0, bottom = 0;
  for (const std::size_t cell : cells) {
    const auto x = static_cast<double>(cell % track.cell_columns);
    const auto y = static_cast<double>(cell / track.cell_columns);
    left = std::min(left, x - 1);
    right = std::max(right, x + 2);
    top = std::min(top, y - 1);
    bottom = std::max(bottom, y + 2);
  }
  const double side = track.cell_side;
  return {{side * left, side * top}, side * (right - left), side * (bottom - top)};
}

std::vector<RegionChange> whole_within(const select::Rectangle& box, double larger, double smaller) {
  return {{RegionChange::Kind::within, 0.0, box},
          {RegionChange::Kind::largest, 0.0, {}},
          {RegionChange::Kind::smooth, kSmoothRadius, {}},
          {RegionChange::Kind::grow, kCloseRadius + larger, {}},
          {RegionChange::Kind::fill_holes, 0.0, {}},
          {RegionChange::Kind::shrink, kCloseRadius + smaller, {}}};
}

Exchange exchanged_by(const SubjectTrack& track, CaptureSource& capture, const std::string& name,
                      std::uint32_t by_codes) {
  constexpr std::size_t kLooks = 4;  // what something else covers is seldom covered at all of them
  if (track.places.empty()) return {};
  const auto look_of = [&](std::uint64_t sample) {
    return static_cast<std::size_t>(std::ranges::lower_bound(track.looked_at, sample) - track.looked_at.begin());
  };
  std::size_t first = look_of(track.places.front().sample), last = look_of(track.places.back().sample);
  for (const SampleRange& rest : track.rests) {  // what rests at an end is what was put down, or will be taken away
    if (rest.first == track.places.front().sample) {
      first = look_of(rest.last);
    } else if (rest.last == track.places.back().sample + 1) {
      last = look_of(rest.first) - 1;
    }
  }
  if (first < kLooks || last < first || last + kLooks >= track.looked_at.size()) return {};
  const auto picture_at = [&](std::size_t look) { return stated_sample(track.looked_at[look], capture.timeline()); };
  MaskStep step;
  step.name = "what is put down or taken away";
  step.selection = select::Difference{picture_at(first - kLooks), picture_at(last + kLooks)};
  step.by_codes = by_codes;
  Exchange exchange;
  exchange.cell_columns = track.cell_columns;
  for (std::vector<std::size_t>& cells : exchanged_cells(track, first - kLooks, last + 1, kLooks)) {
    const select::Rectangle box = box_round(cells, track);
    step.changes = whole_within(box, 0, 0);
    MaskRequest alone;
    alone.steps = {step};
    if (reaches_border(make_mask(alone, &capture, name).mask, box)) continue;
    exchange.things.push_back({std::move(cells), step});
  }
  return exchange;
}

std::vector<MaskStep> exchange_steps(const Exchange& exchange, const SubjectPlace& place, std::uint8_t tag,
                                     std::uint32_t border) {
  std::vector<MaskStep> steps;
  const auto most = static_cast<double>(place.cells.size());
  for (const Exchange::Thing& thing : exchange.things) {
    const auto size = static_cast<double>(thing.cells.size());
    if (size > most || size < kMinExchanged * most || !touches(place, thing.cells, exchange.cell_columns)) continue;
    MaskStep& step = steps.emplace_back(thing.step);
    step.tag = tag;
    step.changes = whole_within(step.changes.front().rectangle, border, 0);
  }
  return steps;
}

}  // namespace nutik
