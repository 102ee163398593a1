#include "opencl/band_split.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "imev/tile.hpp"

namespace nutik {
namespace {

// In less time launches and threads take most of it, and there is little to win.
constexpr double kMinSeconds = 0.005;
// What the first device takes of the last one's time.
constexpr double kBalanced = 0.8;
// A slower device gets no smaller share: now and then it has a row of tiles, and is measured again.
constexpr double kMinShare = 1.0 / 256;

void make_whole(std::vector<double>& shares) {
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (double& share : shares) share /= sum;
}

}  // namespace

BandSplit::BandSplit(std::span<const double> speeds) : shares_(speeds.begin(), speeds.end()) {
  make_whole(shares_);
}

std::vector<Rectangle> BandSplit::cut(const Rectangle& rectangle) const {
  const std::uint64_t end = std::uint64_t{rectangle.y} + rectangle.height;
  const std::uint64_t first_row = rectangle.y / kTileSide;
  const std::uint64_t rows = (end + kTileSide - 1) / kTileSide - first_row;
  std::vector<Rectangle> bands;
  double share = 0.0;
  std::uint64_t y = rectangle.y;
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    share += shares_[i];
    const auto row = static_cast<std::uint64_t>(std::llround(share * static_cast<double>(rows)));
    const bool is_last = i + 1 == shares_.size();
    const std::uint64_t until = is_last ? end : std::clamp((first_row + row) * kTileSide, y, end);
    bands.push_back(
        {rectangle.x, static_cast<std::uint32_t>(y), rectangle.width, static_cast<std::uint32_t>(until - y)});
    y = until;
  }
  return bands;
}

void BandSplit::took(std::span<const Rectangle> bands, std::span<const double> seconds) {
  double least = std::numeric_limits<double>::infinity(), most = 0.0, measured = 0.0, rate = 0.0;
  const auto rate_of = [&](std::size_t i) {
    return bands[i].height / std::max(seconds[i], kMinSeconds / 16);
  };
  for (std::size_t i = 0; i < bands.size(); ++i) {
    if (bands[i].height == 0) continue;
    least = std::min(least, seconds[i]);
    most = std::max(most, seconds[i]);
    measured += shares_[i];
    rate += rate_of(i);
  }
  if (most < kMinSeconds || least >= kBalanced * most) return;
  for (std::size_t i = 0; i < bands.size(); ++i) {
    if (bands[i].height > 0) shares_[i] = std::max(measured * rate_of(i) / rate, kMinShare);
  }
  make_whole(shares_);
}

}  // namespace nutik
