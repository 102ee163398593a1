#include "scene/shots.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "imev/each_block.hpp"

namespace nutik {
namespace {

constexpr std::uint32_t kMostCellsToASide = 48;
constexpr double kLeastChange = 1.0 / 16;  // of a cell's mean, as a share of white
constexpr double kLeastChanged = 0.6;      // of all cells, at a cut
constexpr double kMostBeside = 0.6;        // of that, from each of the two pictures to the next on its side

using Means = std::vector<float>;

// Means of channels over cells, as shares of white; of every third row, for all take long.
template <typename Code>
Means means_of(const CaptureFormat& capture, const Code* codes) {
  const auto [width, height, channels] = capture.shape;
  const std::uint32_t side = (std::max(width, height) - 1) / kMostCellsToASide + 1;
  const std::uint32_t columns = (width - 1) / side + 1, rows = (height - 1) / side + 1;
  const std::uint32_t step = side >= 6 ? 3 : 1;
  std::vector<double> sums(std::size_t{columns} * rows * channels);
  std::vector<std::uint32_t> counts(std::size_t{columns} * rows);
  for (std::uint32_t y = 0; y < height; y += step) {
    const Code* code = codes + std::size_t{y} * width * channels;
    const std::size_t row = std::size_t{y / side} * columns;
    for (std::uint32_t x = 0; x < width; ++x) {
      const std::size_t cell = row + x / side;
      ++counts[cell];
      for (std::uint32_t channel = 0; channel < channels; ++channel)
        sums[cell * channels + channel] += *code++;
    }
  }
  Means means;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    means.push_back(static_cast<float>(
        sums[i] / (static_cast<double>(capture.white_code) * std::max(counts[i / channels], 1u))));
  }
  return means;
}

// What share of the cells differs.
double changed(const Means& a, const Means& b, std::uint32_t channels) {
  std::size_t count = 0;
  for (std::size_t cell = 0; cell < a.size(); cell += channels) {
    bool differs = false;
    for (std::size_t i = cell; i < cell + channels; ++i) differs |= std::abs(a[i] - b[i]) > kLeastChange;
    count += differs ? 1 : 0;
  }
  return static_cast<double>(count * channels) / static_cast<double>(a.size());
}

// How much two pictures are alike up to brightness and contrast, as a camera or a lamp changes them: 1 of the same scene.
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
  return share >= kLeastChanged && correlation(a, b) > kSameScene ? 0 : share;
}

}  // namespace

std::vector<SampleRange> shots_of(CaptureSource& capture) {
  const CaptureFormat& format = capture.format();
  const std::uint64_t count = capture.timeline().sample_count();
  std::vector<std::byte> raster(format.sample_bytes());
  Means before, last;
  std::vector<double> steps{0}, double_steps{0};  // from one sample, and from two, before each
  for_each_block(capture, [&](const BlockView& block) {
    for (std::uint32_t k = 0; k < block.extent().sample_count; ++k) {
      block.read_sample(k, raster);
      Means means = format.code_bytes == 1
                        ? means_of(format, reinterpret_cast<const std::uint8_t*>(raster.data()))
                        : means_of(format, reinterpret_cast<const std::uint16_t*>(raster.data()));
      if (!last.empty()) steps.push_back(step_between(means, last, format.shape.channels));
      if (!before.empty()) double_steps.push_back(step_between(means, before, format.shape.channels));
      before = std::move(last);
      last = std::move(means);
    }
  });
  std::vector<SampleRange> shots;
  std::uint64_t first = 0;
  for (std::uint64_t k = 1; k < count; ++k) {
    if (steps[k] < kLeastChanged) continue;
    if (k > 1 && steps[k - 1] > kMostBeside * steps[k]) continue;
    if (k + 1 < count && (steps[k + 1] > kMostBeside * steps[k] || double_steps[k] < kLeastChanged)) continue;
    shots.push_back({first, k});
    first = k;
  }
  shots.push_back({first, count});
  return shots;
}

}  // namespace nutik
