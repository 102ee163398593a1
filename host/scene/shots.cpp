#include "scene/shots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "capture/format.hpp"
#include "capture/text.hpp"
#include "scene/looks.hpp"
#include "system/parallel.hpp"

namespace nutik {

ThinRaster::ThinRaster(const CaptureFormat& capture, std::uint32_t step)
    : thin_(capture), shape_(capture.shape), grid_(capture.shape), step_(step) {
  thin_.shape.width = (shape_.width - 1) / step + 1;
  thin_.shape.height = (shape_.height - 1) / step + 1;
  raster_.resize(thin_.sample_bytes());
}

void ThinRaster::take(const SampleCursor& held, std::span<const std::uint32_t> tiles) {
  const bool is_grey = shape_.channels == 1;
  if (thin_.code_bytes == 1) {
    is_grey ? take<std::uint8_t, 1>(held, tiles) : take<std::uint8_t, 3>(held, tiles);
  } else {
    is_grey ? take<std::uint16_t, 1>(held, tiles) : take<std::uint16_t, 3>(held, tiles);
  }
}

template <typename Code, std::size_t kChannels>
void ThinRaster::take(const SampleCursor& held, std::span<const std::uint32_t> tiles) {
  auto* const thin = reinterpret_cast<Code*>(raster_.data());
  const auto first_from = [&](std::uint32_t pixel) { return (pixel + step_ - 1) / step_ * step_; };
  const auto take_tile = [&](std::uint32_t tile) {
    const std::uint32_t left = tile % grid_.columns() * kTileSide, top = tile / grid_.columns() * kTileSide;
    const std::uint32_t right = std::min(left + kTileSide, shape_.width);
    const std::uint32_t bottom = std::min(top + kTileSide, shape_.height);
    const auto* const codes = reinterpret_cast<const Code*>(held.codes(tile));
    const std::uint32_t first = first_from(left);
    for (std::uint32_t y = first_from(top); y < bottom; y += step_) {
      Code* to = thin + (std::size_t{y / step_} * thin_.shape.width + first / step_) * kChannels;
      for (std::uint32_t x = first; x < right; x += step_) {
        const Code* const from = codes + TileGrid::lane_of(x, y);
        for (std::size_t channel = 0; channel < kChannels; ++channel) *to++ = from[channel * kTilePixels];
      }
    }
  };
  parallel_for_parts(tiles.size(), 2048, [&](std::uint64_t first, std::uint64_t last) {
    std::ranges::for_each(tiles.subspan(first, last - first), take_tile);
  });
}

namespace {

constexpr std::uint32_t kMaxCellsToASide = 48;
constexpr double kMinChange = 1.0 / 16;  // of a cell's mean, as a share of white
constexpr double kMinChanged = 0.6;      // of all cells, at a cut
constexpr double kMaxBeside = 0.6;        // of that, from each of the two pictures to the next on its side

using Means = std::vector<float>;

// At least 64 pixels of a large cell are looked at.
std::uint32_t step_of(const Shape& shape) {
  return std::max((std::max(shape.width, shape.height) - 1) / kMaxCellsToASide / 8, 1u);
}

std::uint32_t side_of(const Shape& shape) { return (std::max(shape.width, shape.height) - 1) / kMaxCellsToASide + 1; }

Shape cells_of(const Shape& shape) {
  const std::uint32_t side = side_of(shape);
  return {(shape.width - 1) / side + 1, (shape.height - 1) / side + 1, shape.channels};
}

// Means of channels over cells, as shares of white.
template <typename Code>
Means means_of(const CaptureFormat& format, std::span<const std::byte> raster) {
  const auto [width, height, channels] = format.shape;
  const auto* codes = reinterpret_cast<const Code*>(raster.data());
  const std::uint32_t side = side_of(format.shape);
  const Shape cells = cells_of(format.shape);
  std::vector<std::uint64_t> sums(cells.pixel_count() * channels);
  std::vector<std::uint32_t> counts(cells.pixel_count());
  for (std::uint32_t y = 0; y < height; ++y) {
    std::size_t cell = std::size_t{y / side} * cells.width;
    for (std::uint32_t x = 0; x < width; ++cell) {
      const std::uint32_t end = std::min(x + side, width);
      std::array<std::uint64_t, 3> of_row{};
      counts[cell] += end - x;
      for (; x < end; ++x) {
        for (std::uint32_t channel = 0; channel < channels; ++channel) of_row[channel] += *codes++;
      }
      for (std::uint32_t channel = 0; channel < channels; ++channel) sums[cell * channels + channel] += of_row[channel];
    }
  }
  Means means;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    means.push_back(static_cast<float>(static_cast<double>(sums[i]) /
                                       (static_cast<double>(format.white_code) * counts[i / channels])));
  }
  return means;
}

// What share of the cells differs.
double changed(const Means& a, const Means& b, std::uint32_t channels) {
  std::size_t count = 0;
  for (std::size_t cell = 0; cell < a.size(); cell += channels) {
    bool differs = false;
    for (std::size_t i = cell; i < cell + channels; ++i) differs |= std::abs(a[i] - b[i]) > kMinChange;
    count += differs ? 1 : 0;
  }
  return static_cast<double>(count * channels) / static_cast<double>(a.size());
}

// How much two pictures are alike up to brightness and contrast, as a camera or a lamp changes them: 1 of the same
// scene.
double correlation(const Means& a, const Means& b) {
  const auto count = static_cast<double>(a.size());
  double sum_a = 0, sum_b = 0, aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double x = a[i], y = b[i];
    sum_a += x;
    sum_b += y;
    aa += x * x;
    bb += y * y;
    ab += x * y;
  }
  const double spread = (aa - sum_a * sum_a / count) * (bb - sum_b * sum_b / count);
  return spread > 0 ? (ab - sum_a * sum_b / count) / std::sqrt(spread) : 0;
}

// A share of cells that differ; none where the scene is the same.
double step_between(const Means& a, const Means& b, std::uint32_t channels) {
  constexpr double kSameScene = 0.8;
  const double share = changed(a, b, channels);
  return share >= kMinChanged && correlation(a, b) > kSameScene ? 0 : share;
}

// Whether the picture at an end of the capture is alone: a chart before a recording, or what a camera ends one with.
// `steps` lead away from it. Where a share of the scene is replaced, pictures are correlated by the rest; a camera that
// sets its exposure at the beginning replaces nothing.
bool stands_alone(double correlation, std::span<const double> steps) {
  constexpr double kMinReplaced = 1.0 / 16, kSameScene = 1 - kMinReplaced / 2;
  constexpr double kMinTimesOthers = 8;
  constexpr std::size_t kOthers = 8;
  if (steps.size() <= kOthers || steps[0] < kMinReplaced || correlation > kSameScene) return false;
  return steps[0] >= kMinTimesOthers * std::ranges::max(steps.subspan(1, kOthers));
}

}  // namespace

ShotFinder::ShotFinder(const CaptureFormat& format) : format_(format), dissolves_(cells_of(format.shape)) {}

void ShotFinder::add(std::span<const std::byte> raster) {
  std::vector<float> means = format_.code_bytes == 1 ? means_of<std::uint8_t>(format_, raster)
                                                     : means_of<std::uint16_t>(format_, raster);
  dissolves_.add(means);
  const std::uint32_t channels = format_.shape.channels;
  steps_.push_back(last_.empty() ? 0 : step_between(means, last_, channels));
  if (!last_.empty()) correlations_.push_back(correlation(means, last_));
  double_steps_.push_back(before_.empty() ? 0 : step_between(means, before_, channels));
  before_ = std::move(last_);
  last_ = std::move(means);
}

std::vector<SampleRange> ShotFinder::shots() const {
  const std::uint64_t count = steps_.size();
  if (count == 0) return {};
  const std::vector<double> from_first(steps_.begin() + 1, steps_.end());
  const std::vector<double> from_last(from_first.rbegin(), from_first.rend());
  const bool is_first_alone = count > 1 && stands_alone(correlations_.front(), from_first);
  const bool is_last_alone = count > 1 && stands_alone(correlations_.back(), from_last);
  const auto is_cut = [&](std::uint64_t k) {
    if ((k == 1 && is_first_alone) || (k + 1 == count && is_last_alone)) return true;
    if (steps_[k] < kMinChanged) return false;
    if (k > 1 && steps_[k - 1] > kMaxBeside * steps_[k]) return false;
    return k + 1 == count || (steps_[k + 1] <= kMaxBeside * steps_[k] && double_steps_[k] >= kMinChanged);
  };
  std::vector<SampleRange> shots;
  std::uint64_t first = 0;
  const auto end_at = [&](std::uint64_t last, std::uint64_t next) {
    if (first < last) shots.push_back({first, last});
    first = std::max(first, next);
  };
  auto dissolve = dissolves_.found().begin();
  for (std::uint64_t k = 1; k < count; ++k) {
    if (dissolve != dissolves_.found().end() && dissolve->first == k) {
      end_at(k, dissolve->last);
      ++dissolve;
    } else if (is_cut(k)) {
      end_at(k, k);
    }
  }
  end_at(count, count);
  return shots;
}

std::vector<SampleRange> shots_of(CaptureSource& capture) {
  const std::uint64_t count = capture.timeline().sample_count();
  ThinRaster thin(capture.format(), step_of(capture.format().shape));
  ShotFinder finder(thin.format());
  for_each_look(capture, Looks(count, count), [&](const Look& look) {
    thin.take(look.held, look.changed);
    finder.add(thin.raster());
  });
  return finder.shots();
}

std::string starts_of(std::span<const SampleRange> shots, std::uint64_t part) {
  std::uint64_t last = 0;
  return joined(shots, ", ", [&](const SampleRange& shot) {
    const std::string dissolve =
        shot.first == last ? std::string() : format(" (behind a dissolve or fade from {} on)", part + last);
    last = shot.last;
    return format("{}{}{}", part + shot.first, shot.size() == 1 ? " (a single one)" : "", dissolve);
  });
}

}  // namespace nutik
