#include "scene/place_times.hpp"

#include <algorithm>
#include <cstdlib>

#include "system/parallel.hpp"

namespace nutik {
namespace {

// Counts every code that may be held: damaged files have some above white.
std::size_t code_count(const CaptureFormat& capture) { return std::size_t{1} << 8 * capture.code_bytes; }

constexpr std::uint32_t kCellsToASide = 48;
constexpr std::uint32_t kManyUncertain = 16;  // one of so many pixels, or more: cells hang together
constexpr std::uint32_t kSpotsToASide = 3;    // of a cell
constexpr double kMaxOfAPlace = 0.6;         // looks the same at two looks
// A place that never looks the same for so much of the time has no look of its own: leaves, or noise.
constexpr double kMinAlike = 1.0 / 8;

}  // namespace

CodeBand CodeBand::of_codes(const CaptureFormat& capture, std::uint32_t codes) {
  CodeBand band;
  std::vector<std::uint32_t> bins(code_count(capture));
  for (std::uint32_t code = 0; code < bins.size(); ++code) bins[code] = std::min(code, capture.white_code);
  band.bins_.assign(capture.shape.channels, bins);
  band.window_ = 2 * std::min(codes, capture.white_code) + 1;
  return band;
}

CodeBand CodeBand::of_noise(const CaptureFormat& capture, const CameraNoise& noise) {
  constexpr double kSigmas = 3.0;
  constexpr std::uint32_t kBinsToASide = 8;
  const double least = std::max(1.0, kMinShare * capture.white_code);
  CodeBand band;
  for (std::uint32_t channel = 0; channel < capture.shape.channels; ++channel) {
    std::vector<std::uint32_t>& bins = band.bins_.emplace_back();
    double place = 0;  // in bins: codes that stray further are packed closer
    for (std::uint32_t code = 0; code <= capture.white_code; ++code) {
      bins.push_back(static_cast<std::uint32_t>(place));
      place += kBinsToASide / std::max(least, kSigmas * noise.sd(channel, code));
    }
    bins.resize(code_count(capture), bins.back());
  }
  band.window_ = 2 * kBinsToASide + 1;
  return band;
}

std::uint32_t CodeBand::bin_count() const {
  std::uint32_t count = 0;
  for (const std::vector<std::uint32_t>& bins : bins_) count = std::max(count, bins.back() + 1);
  return count;
}

std::uint32_t PlaceTimes::cell_side(const Shape& shape) {
  return (std::max(shape.width, shape.height) - 1) / kCellsToASide + 1;
}

MemoryNeeds PlaceTimes::needs(const CaptureFormat& capture) {
  const std::uint64_t side = cell_side(capture.shape);
  const std::uint64_t cells =
      ((capture.shape.width - 1) / side + 1) * ((capture.shape.height - 1) / side + 1);
  const std::uint64_t spots = std::min(cells * kSpotsToASide * kSpotsToASide, capture.shape.pixel_count());
  return {{"uncertain places at some samples",
           spots * Looks::kMax * capture.shape.channels * sizeof(std::uint16_t)}};
}

PlaceTimes::PlaceTimes(CaptureSource& capture, const Region& uncertain, const CodeBand& band,
                       const std::function<void()>& keep_going)
    : timeline_(capture.timeline()),
      looks_(timeline_.sample_count()),
      side_(cell_side(capture.format().shape)),
      columns_((uncertain.width - 1) / side_ + 1),
      rows_((uncertain.height - 1) / side_ + 1) {
  for (std::uint64_t look = 0; look < looks_.count(); ++look) {
    starts_ns_.push_back(timeline_.start_ns(looks_.sample(look)));
  }
  starts_ns_.push_back(timeline_.duration_ns());
  for (std::uint64_t sample = 0; sample < timeline_.sample_count(); ++sample) {
    const std::uint64_t look = looks_.before(sample);
    samples_.push_back({timeline_.start_ns(sample) - starts_ns_[look], static_cast<std::uint32_t>(look)});
  }

  const std::uint32_t channels = capture.format().shape.channels;
  const std::vector<std::vector<Spot>> places = spots_of_places(uncertain);
  std::vector<std::vector<std::uint16_t>> bins(places.size());
  for_each_look(capture, looks_, [&](const Look& look) {
    keep_going();
    for (std::size_t place = 0; place < places.size(); ++place) {
      for (const Spot& spot : places[place]) {
        for (std::uint32_t channel = 0; channel < channels; ++channel) {
          const std::uint32_t code = look.held.code(spot.x, spot.y, channel);
          bins[place].push_back(static_cast<std::uint16_t>(band.bin(channel, code)));
        }
      }
    }
  });
  clocks_.resize(places.size());
  parallel_for(places.size(), [&](std::uint64_t place) {
    clocks_[place] = clock_of(bins[place], channels, band.window() / 2, keep_going);
  });
}

std::vector<std::vector<PlaceTimes::Spot>> PlaceTimes::spots_of_places(const Region& uncertain) {
  Region many = Region::none(columns_, rows_);
  std::vector<std::vector<std::size_t>> places;
  std::vector<std::vector<Spot>> spots_of_cells(std::size_t{columns_} * rows_);
  for (std::uint32_t row = 0; row < rows_; ++row) {
    for (std::uint32_t column = 0; column < columns_; ++column) {
      const std::uint32_t right = std::min((column + 1) * side_, uncertain.width);
      const std::uint32_t bottom = std::min((row + 1) * side_, uncertain.height);
      std::vector<Spot> spots;
      for (std::uint32_t y = row * side_; y < bottom; ++y) {
        for (std::uint32_t x = column * side_; x < right; ++x) {
          if (uncertain.inside[std::size_t{y} * uncertain.width + x] != 0) spots.push_back({x, y});
        }
      }
      const std::size_t cell = std::size_t{row} * columns_ + column;
      if (spots.empty()) continue;
      many.inside[cell] = kManyUncertain * spots.size() >= std::size_t{side_} * side_;
      if (many.inside[cell] == 0) places.push_back({cell});
      const std::size_t kept = std::min<std::size_t>(spots.size(), kSpotsToASide * kSpotsToASide);
      for (std::size_t i = 0; i < kept; ++i) {
        spots_of_cells[cell].push_back(spots[i * spots.size() / kept]);
      }
    }
  }
  for (std::vector<std::size_t>& part : parts_of(many, 1)) places.push_back(std::move(part));
  clock_of_cell_.assign(spots_of_cells.size(), 0);
  std::vector<std::vector<Spot>> spots(places.size());
  for (std::size_t place = 0; place < places.size(); ++place) {
    for (const std::size_t cell : places[place]) {
      clock_of_cell_[cell] = place;
      spots[place].insert(spots[place].end(), spots_of_cells[cell].begin(), spots_of_cells[cell].end());
    }
  }
  return spots;
}

PlaceTimes::Clock PlaceTimes::clock_of(const std::vector<std::uint16_t>& bins, std::uint32_t channels,
                                       std::uint32_t reach, const std::function<void()>& keep_going) const {
  const std::size_t looks = looks_.count(), values = bins.size() / looks;
  // What share of the place looks the same at two looks.
  std::vector<float> same(looks * looks, 1.0F);
  for (std::size_t a = 0; a < looks; ++a) {
    keep_going();
    for (std::size_t b = 0; b < a; ++b) {
      const std::uint16_t *of_a = &bins[a * values], *of_b = &bins[b * values];
      std::size_t count = 0;
      for (std::size_t spot = 0; spot < values; spot += channels) {
        bool differs = false;
        for (std::size_t value = spot; value < spot + channels; ++value) {
          differs |= static_cast<std::uint32_t>(std::abs(int{of_a[value]} - int{of_b[value]})) > reach;
        }
        count += differs ? 0 : 1;
      }
      same[a * looks + b] = same[b * looks + a] =
          static_cast<float>(count * channels) / static_cast<float>(values);
    }
  }
  // The look that most of the time is like.
  std::size_t best = 0;
  double longest = 0;
  for (std::size_t a = 0; a < looks; ++a) {
    double like_it = 0;
    for (std::size_t b = 0; b < looks; ++b) {
      const double share = same[a * looks + b];
      like_it += share * share * static_cast<double>(starts_ns_[b + 1] - starts_ns_[b]);
    }
    if (like_it <= longest) continue;
    longest = like_it;
    best = a;
  }
  std::vector<std::uint8_t> runs;
  std::int64_t alike_ns = 0;
  for (std::size_t look = 0; look < looks; ++look) {
    runs.push_back(same[best * looks + look] >= kMaxOfAPlace ? 1 : 0);
    if (runs.back() != 0) alike_ns += starts_ns_[look + 1] - starts_ns_[look];
  }
  if (static_cast<double>(alike_ns) < kMinAlike * static_cast<double>(timeline_.duration_ns())) {
    runs.assign(looks, 1);
  }
  Clock clock;
  std::int64_t before_ns = 0;
  for (std::size_t look = 0; look < looks; ++look) {
    clock.runs.push_back(runs[look]);
    clock.before_ns.push_back(before_ns);
    if (clock.runs.back() != 0) before_ns += starts_ns_[look + 1] - starts_ns_[look];
  }
  clock.before_ns.push_back(before_ns);
  return clock;
}

std::int64_t PlaceTimes::clock_ns(std::uint32_t x, std::uint32_t y, std::uint64_t sample) const {
  const Clock& clock = clock_of(x, y);
  if (sample == samples_.size()) return clock.before_ns.back();
  const Begin& begin = samples_[sample];
  return clock.before_ns[begin.look] + (clock.runs[begin.look] != 0 ? begin.since_look_ns : 0);
}

}  // namespace nutik
