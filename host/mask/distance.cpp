#include "mask/distance.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "system/interruption.hpp"

namespace nutik {
namespace {

// For each x of a row the least of (x - u)² + f(u) over all u, by the lower envelope of the parabolas
// (P. Felzenszwalb and D. Huttenlocher, Distance Transforms of Sampled Functions, 2012). All in whole
// numbers: `starts[k]` is the first x at which parabola k is not above the one before.
class Envelope {
 public:
  void run(std::span<const std::uint64_t> f, std::vector<std::uint64_t>& least) {
    places_.clear();
    starts_.clear();
    const auto count = static_cast<std::int64_t>(f.size());
    for (std::int64_t u = 0; u < count; ++u) {
      if (f[static_cast<std::size_t>(u)] == kFarAway) continue;
      std::int64_t start = 0;
      while (!places_.empty()) {
        start = overtakes(f, places_.back(), u);
        if (start > starts_.back()) break;
        places_.pop_back();
        starts_.pop_back();
        start = 0;
      }
      if (start >= count) continue;
      places_.push_back(u);
      starts_.push_back(start);
    }
    least.assign(f.size(), kFarAway);
    std::size_t k = 0;
    for (std::int64_t x = 0; x < count && !places_.empty(); ++x) {
      while (k + 1 < starts_.size() && starts_[k + 1] <= x) ++k;
      const std::int64_t from = x - places_[k];
      least[static_cast<std::size_t>(x)] =
          static_cast<std::uint64_t>(from * from) + f[static_cast<std::size_t>(places_[k])];
    }
  }

 private:
  // The first x >= 0 from which on the parabola at v > u is not above that at u: where
  // (x - v)² + f(v) <= (x - u)² + f(u), that is x >= (f(v) + v² - f(u) - u²) / (2 (v - u)).
  static std::int64_t overtakes(std::span<const std::uint64_t> f, std::int64_t u, std::int64_t v) {
    const auto height = [&](std::int64_t at) {
      return static_cast<std::int64_t>(f[static_cast<std::size_t>(at)]) + at * at;
    };
    const std::int64_t rise = height(v) - height(u), run = 2 * (v - u);
    return rise <= 0 ? 0 : (rise + run - 1) / run;
  }

  std::vector<std::int64_t> places_;
  std::vector<std::int64_t> starts_;
};

Region grown_whole(const Region& region, double radius) {
  const std::vector<std::uint64_t> distances = squared_distances(region);
  Region result = Region::none(region.width, region.height);
  for (std::size_t pixel = 0; pixel < distances.size(); ++pixel) {
    result.inside[pixel] = static_cast<double>(distances[pixel]) <= radius * radius ? 1 : 0;
  }
  return result;
}

// A region of which no pixel changes further than `reach` from one inside: looks at the least box with all of these.
template <typename Change>
Region changed_near(const Region& region, double reach, Change change) {
  const std::size_t width = region.width, height = region.height;
  std::size_t left = width, right = 0, top = height, bottom = 0;  // right and bottom lie behind it
  for (std::size_t y = 0; y < height; ++y) {
    const auto row = region.inside.begin() + static_cast<std::ptrdiff_t>(y * width);
    const auto end = row + static_cast<std::ptrdiff_t>(width);
    const auto first = std::find(row, end, std::uint8_t{1});
    if (first == end) continue;
    const auto last =
        std::find(std::make_reverse_iterator(end), std::make_reverse_iterator(row), std::uint8_t{1});
    left = std::min(left, static_cast<std::size_t>(first - row));
    right = std::max(right, static_cast<std::size_t>(last.base() - row));
    top = std::min(top, y);
    bottom = y + 1;
  }
  if (bottom == 0) return region;
  const auto margin =
      static_cast<std::size_t>(std::min(std::ceil(reach), static_cast<double>(width + height)));
  left -= std::min(left, margin);
  top -= std::min(top, margin);
  right = std::min(right + margin, width);
  bottom = std::min(bottom + margin, height);
  Region part =
      Region::none(static_cast<std::uint32_t>(right - left), static_cast<std::uint32_t>(bottom - top));
  for (std::size_t y = top; y < bottom; ++y) {
    std::copy_n(&region.inside[y * width + left], part.width, &part.inside[(y - top) * part.width]);
  }
  part = change(part);
  Region result = Region::none(region.width, region.height);
  for (std::size_t y = top; y < bottom; ++y) {
    std::copy_n(&part.inside[(y - top) * part.width], part.width, &result.inside[y * width + left]);
  }
  return result;
}

}  // namespace

std::vector<std::uint64_t> squared_distances(const Region& region) {
  const std::size_t width = region.width, height = region.height;
  std::vector<std::uint64_t> distances(width * height);
  Envelope envelope;
  std::vector<std::uint64_t> line(height), least;
  for (std::size_t x = 0; x < width; ++x) {
    check_interruption();
    for (std::size_t y = 0; y < height; ++y) line[y] = region.inside[y * width + x] != 0 ? 0 : kFarAway;
    envelope.run(line, least);
    for (std::size_t y = 0; y < height; ++y) distances[y * width + x] = least[y];
  }
  for (std::size_t y = 0; y < height; ++y) {
    check_interruption();
    const std::span row(distances.data() + y * width, width);
    envelope.run(row, least);
    std::copy(least.begin(), least.end(), row.begin());
  }
  return distances;
}

Region grown(const Region& region, double radius) {
  return changed_near(region, radius, [&](const Region& part) { return grown_whole(part, radius); });
}

Region shrunk(const Region& region, double radius) {
  return changed_near(region, 1,
                      [&](const Region& part) { return inverted(grown_whole(inverted(part), radius)); });
}

Region smoothed(const Region& region, double radius) {
  const Region opened = grown(shrunk(region, radius), radius);
  return shrunk(grown(opened, radius), radius);
}

}  // namespace nutik
