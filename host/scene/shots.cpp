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
constexpr double kMinChanged = 0.6;      // of all cells, at a cut and over a dissolve
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

// From one end of a dissolve to the other, in pictures: steps of about a fifth.
constexpr std::array<std::size_t, 14> kLengths{6, 8, 10, 12, 14, 17, 20, 24, 28, 33, 39, 46, 54, 64};
// How much its ends may be alike: unrelated scenes often have their light above and their ground below.
constexpr double kMaxCoarse = 0.5, kMaxFine = 0.2;
// What a sum leaves unexplained, as a share of a quarter of both ends' contrast, which an even mixture has: in most
// cells, and of all at a single picture. In one of so many cells, where most is left, something moves. Measured: more
// than 0.07 of pans, zooms and blurs of real clips that leave less than 0.6 of the fine structure.
constexpr double kMaxLeft = 0.06, kMaxLeftOnce = 0.4, kMaxFineLeft = 0.4;
constexpr std::size_t kMoving = 10;
constexpr double kMaxAhead = 0.34, kMaxBack = 0.05;  // of the way from one end to the other
constexpr double kMixed = 0.15;                     // of the way from either end
constexpr double kMinMixed = 0.3;                   // of all pictures between the ends
constexpr double kBeyond = 1.0 / 8;                 // of a dissolve

double product(std::span<const float> a, std::span<const float> b) {
  std::array<float, 16> sums{};
  std::size_t i = 0;
  for (; i + sums.size() <= a.size(); i += sums.size())
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += a[i + k] * b[i + k];
  double sum = 0;
  for (; i < a.size(); ++i) sum += a[i] * b[i];
  for (const float part : sums) sum += part;
  return sum;
}

// A picture as a sum of two others.
struct Sum {
  double of_first, of_second, left;
  [[nodiscard]] double way() const { return (1 - of_first + of_second) / 2; }
};

template <typename Layer>
Sum sum_of(const Layer& first, const Layer& second, double both, const Layer& between) {
  const double of_first = product(first.values, between.values), of_second = product(second.values, between.values);
  const double spread = first.square * second.square - both * both;
  const double u = (of_first * second.square - of_second * both) / spread;
  const double v = (of_second * first.square - of_first * both) / spread;
  return {u, v, between.square - u * of_first - v * of_second};
}

}  // namespace

void DissolveFinder::add(const std::vector<float>& means) {
  const std::uint32_t width = cells_.width, height = cells_.height, channels = cells_.channels;
  Look look{means, {means, 0}, {means, 0}};
  double mean = 0;
  for (const float value : means) mean += value;
  for (float& value : look.coarse.values) value -= static_cast<float>(mean / static_cast<double>(means.size()));
  std::size_t exposed = 0;
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      constexpr float kBlack = 1.0F / 32, kWhite = 1 - kBlack;
      bool is_exposed = true;
      for (std::uint32_t channel = 0; channel < channels; ++channel) {
        const auto at = [&](std::uint32_t column, std::uint32_t row) {
          return means[(std::size_t{row} * width + column) * channels + channel];
        };
        const float beside = at(x > 0 ? x - 1 : x, y) + at(x + 1 < width ? x + 1 : x, y) +
                             at(x, y > 0 ? y - 1 : y) + at(x, y + 1 < height ? y + 1 : y);
        look.fine.values[(std::size_t{y} * width + x) * channels + channel] -= beside / 4;
        is_exposed &= at(x, y) > kBlack && at(x, y) < kWhite;
      }
      exposed += is_exposed ? 1 : 0;
    }
  }
  look.is_exposed = 2 * exposed > std::size_t{width} * height;
  for (Layer* layer : {&look.coarse, &look.fine}) layer->square = product(layer->values, layer->values);
  looks_.push_back(std::move(look));
  ++count_;
  if (looks_.size() > kLengths.back() + 1) looks_.pop_front();
  if (!looks_.back().is_exposed) return;
  for (const std::size_t length : kLengths) {
    if (length < looks_.size()) test(looks_.size() - 1 - length);
  }
}

// Whether one shot turns into another from a look to the last one.
void DissolveFinder::test(std::size_t first) {
  const Look &from = looks_[first], &to = looks_.back();
  const std::size_t end = looks_.size() - 1;
  if (!from.is_exposed || changed(from.means, to.means, cells_.channels) <= kMinChanged) return;
  const double coarse = product(from.coarse.values, to.coarse.values), fine = product(from.fine.values, to.fine.values);
  const double both = from.coarse.square + to.coarse.square;
  if (coarse >= kMaxCoarse * std::sqrt(from.coarse.square * to.coarse.square) ||
      fine >= kMaxFine * std::sqrt(from.fine.square * to.fine.square)) {
    return;
  }
  const auto coarse_at = [&](std::size_t k) { return sum_of(from.coarse, to.coarse, coarse, looks_[k].coarse); };
  if (coarse_at((first + end) / 2).left > kMaxLeftOnce * both / 4) return;
  std::vector<const Look*> mixed;
  double before = 0, ways = 0, places = 0, squares = 0, products = 0;
  for (std::size_t k = first + 1; k <= end; ++k) {
    const Sum sum = k < end ? coarse_at(k) : Sum{0, 1, 0};
    const double way = sum.way();
    if (way - before > kMaxAhead || before - way > kMaxBack) return;
    before = way;
    if (way < kMixed || way > 1 - kMixed) continue;
    if (sum.left > kMaxLeftOnce * both / 4) return;
    mixed.push_back(&looks_[k]);
    const auto place = static_cast<double>(k - first);
    ways += way;
    places += place;
    squares += place * place;
    products += place * way;
  }
  const auto count = static_cast<double>(mixed.size());
  const auto explain = [&](const Layer Look::*layer, double product, double most_left) {
    const Layer &a = from.*layer, &b = to.*layer;
    std::vector<float> left(a.values.size() / cells_.channels), contrast(left.size());
    for (const Look* look : mixed) {
      const std::vector<float>& values = (look->*layer).values;
      const Sum sum = sum_of(a, b, product, look->*layer);
      const auto u = static_cast<float>(sum.of_first), v = static_cast<float>(sum.of_second);
      for (std::size_t cell = 0, i = 0; cell < left.size(); ++cell) {
        for (const std::size_t last = i + cells_.channels; i < last; ++i) {
          const float rest = values[i] - u * a.values[i] - v * b.values[i];
          left[cell] += rest * rest;
          contrast[cell] += (a.values[i] * a.values[i] + b.values[i] * b.values[i]) / 4;
        }
      }
    }
    std::vector<float> sorted = left;
    const auto most = sorted.end() - 1 - static_cast<std::ptrdiff_t>(sorted.size() / kMoving);
    std::ranges::nth_element(sorted, most);
    double all_left = 0, all_contrast = 0;
    for (std::size_t cell = 0; cell < left.size(); ++cell) {
      if (left[cell] > *most) continue;
      all_left += left[cell];
      all_contrast += contrast[cell];
    }
    return all_left <= most_left * all_contrast;
  };
  if (mixed.size() < 3 || count <= kMinMixed * static_cast<double>(end - first - 1) ||
      !explain(&Look::coarse, coarse, kMaxLeft) || !explain(&Look::fine, fine, kMaxFineLeft)) {
    return;
  }
  // A straight line through the ways, from 0 to 1, and beyond both ends what a way takes that begins and ends slowly.
  const double slope = (count * products - places * ways) / (count * squares - places * places);
  if (slope <= 0) return;
  const double begin = (places - ways / slope) / count, beyond = kBeyond / slope;
  const auto number = static_cast<double>(count_ - looks_.size() + first);
  SampleRange range{static_cast<std::uint64_t>(std::max(number + std::floor(begin - beyond) + 1, number + 1)),
                    static_cast<std::uint64_t>(std::min(number + std::ceil(begin + 1 / slope + beyond),
                                                        number + static_cast<double>(end - first)))};
  while (!found_.empty() && found_.back().last >= range.first) {
    range.cover(found_.back());
    found_.pop_back();
  }
  found_.push_back(range);
}

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
