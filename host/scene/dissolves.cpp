#include "scene/dissolves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace nutik {
namespace {

// From one end to the other, in pictures: steps of about a fifth.
constexpr std::array<std::size_t, 14> kLengths{6, 8, 10, 12, 14, 17, 20, 24, 28, 33, 39, 46, 54, 64};
constexpr float kOther = 1.0F / 16;  // of a cell's mean, as a share of white
constexpr double kMinOthers = 0.6;  // of all cells
// How much the ends may be alike: unrelated scenes often have their light above and their ground below.
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

bool is_most_changed(std::span<const float> a, std::span<const float> b, std::uint32_t channels) {
  std::size_t count = 0;
  for (std::size_t cell = 0; cell < a.size(); cell += channels) {
    float most = 0;
    for (std::size_t i = cell; i < cell + channels; ++i) most = std::max(most, std::abs(a[i] - b[i]));
    count += most > kOther ? 1 : 0;
  }
  return static_cast<double>(count * channels) > kMinOthers * static_cast<double>(a.size());
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
  if (!from.is_exposed || !is_most_changed(from.means, to.means, cells_.channels)) return;
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
    range.first = std::min(range.first, found_.back().first);
    range.last = std::max(range.last, found_.back().last);
    found_.pop_back();
  }
  found_.push_back(range);
}

}  // namespace nutik
