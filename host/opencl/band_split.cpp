#include "opencl/band_split.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "imev/tile.hpp"

namespace nutik {
namespace {

// In less time launches and threads take most of it, and there is little to win.
constexpr double kMinSeconds = 0.005;
// What the first device takes of the last one's time, at the least, where bands need not move.
constexpr double kBalanced = 0.8;
// What it costs to read blocks again where bands have moved to, as a share of a picture's time.
constexpr double kMoving = 0.5;
// What a picture counts beside the next one: how fast a device is may change.
constexpr double kRemembered = 0.9;
// No smaller share is given when bands move: of 128 rows of tiles and more it is one, by which a device is measured
// again. Of fewer rows so slow a device has none, and would only be waited for.
constexpr double kMinShare = 1.0 / 256;

void make_whole(std::vector<double>& shares) {
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (double& share : shares) share /= sum;
}

}  // namespace

BandSplit::BandSplit(std::span<const double> speeds) : shares_(speeds.begin(), speeds.end()) {
  make_whole(shares_);
  forget();
}

void BandSplit::forget() {
  done_.assign(shares_.size(), Done());
  longest_ = 0.0;
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
  if (*std::ranges::max_element(seconds) < kMinSeconds) return;
  const bool is_by_others = !std::ranges::equal(bands, done_, [](const Rectangle& band, const Done& done) {
    return (band.height > 0) == (done.pixels > 0.0);
  });
  if (is_by_others) forget();
  longest_ *= kRemembered;
  double least = 0.0, most = 0.0, share = 0.0, pixels = 0.0, rate = 0.0;
  for (std::size_t i = 0; i < bands.size(); ++i) {
    Done& done = done_[i];
    if (bands[i].height == 0) continue;
    done.pixels = kRemembered * done.pixels + static_cast<double>(bands[i].height) * bands[i].width;
    done.seconds = kRemembered * done.seconds + std::max(seconds[i], kMinSeconds / 16);
    longest_ = std::max(longest_, seconds[i]);
    least = least == 0.0 ? done.seconds : std::min(least, done.seconds);
    most = std::max(most, done.seconds);
    share += shares_[i];
    pixels += done.pixels;
    rate += done.pixels / done.seconds;
  }
  const double waited = most - pixels / rate;  // longer than if all had been done at the same time
  if (least >= kBalanced * most || waited < kMoving * longest_) return;
  for (std::size_t i = 0; i < bands.size(); ++i) {
    const Done& done = done_[i];
    if (bands[i].height > 0) shares_[i] = std::max(share * done.pixels / done.seconds / rate, kMinShare);
  }
  make_whole(shares_);
  forget();
}

}  // namespace nutik
