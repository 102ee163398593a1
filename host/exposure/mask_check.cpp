#include "exposure/mask_check.hpp"

#include <algorithm>
#include <cstdlib>

#include "capture/format.hpp"
#include "system/interruption.hpp"

namespace nutik {
namespace {

constexpr std::uint64_t kMaxSpeckPixels = 16;
constexpr std::uint64_t kPixelsPerSpeckPixel = 1000;
constexpr std::uint64_t kBlendedShare = 100;
constexpr int kJpegReach = 8;

// Calls visit(neighbour's index) for the up to eight neighbours of a pixel.
template <typename Visit>
void for_each_neighbour(const Mask& mask, std::uint32_t x, std::uint32_t y, Visit visit) {
  for (std::uint32_t ny = y == 0 ? 0 : y - 1; ny <= std::min(y + 1, mask.height - 1); ++ny) {
    for (std::uint32_t nx = x == 0 ? 0 : x - 1; nx <= std::min(x + 1, mask.width - 1); ++nx) {
      if (nx != x || ny != y) visit(std::size_t{ny} * mask.width + nx);
    }
  }
}

// What the pixels of each value have for neighbours.
struct Neighbourhood {
  std::array<std::uint64_t, kMaskValues> between{};  // pixels with a lower and a higher neighbour
  std::array<std::uint64_t, kMaskValues> near{};     // pixels with another one at most kJpegReach away
  std::array<std::size_t, kMaskValues> first{};      // the first pixel

  explicit Neighbourhood(const Mask& mask) {
    std::array<bool, kMaskValues> is_known{};
    for (std::uint32_t y = 0; y < mask.height; ++y) {
      check_interruption();
      for (std::uint32_t x = 0; x < mask.width; ++x) {
        const std::size_t pixel = std::size_t{y} * mask.width + x;
        const int value = mask.tags[pixel];
        bool is_above = false, is_below = false, is_near = false;
        for_each_neighbour(mask, x, y, [&](std::size_t neighbour) {
          const int other = mask.tags[neighbour];
          is_above |= other < value;
          is_below |= other > value;
          is_near |= other != value && std::abs(other - value) <= kJpegReach;
        });
        const auto v = static_cast<std::size_t>(value);
        between[v] += is_above && is_below;
        near[v] += is_near;
        if (!is_known[v]) first[v] = pixel;
        is_known[v] = true;
      }
    }
  }
};

std::vector<BlendedValue> find_blended(const Mask& mask, const std::array<bool, kMaskValues>& is_mapped) {
  const auto counts = mask.pixels_per_tag();
  const Neighbourhood neighbourhood(mask);
  const auto has_strong_neighbour = [&](int value) {
    for (int other = std::max(0, value - kJpegReach);
         other <= std::min<int>(kMaskValues - 1, value + kJpegReach); ++other) {
      if (counts[static_cast<std::size_t>(other)] >=
          kBlendedShare * counts[static_cast<std::size_t>(value)]) {
        return true;
      }
    }
    return false;
  };
  std::vector<BlendedValue> blended;
  for (int value = 0; value < static_cast<int>(kMaskValues); ++value) {
    const auto v = static_cast<std::size_t>(value);
    if (counts[v] == 0 || counts[v] > mask.tags.size() / kBlendedShare) continue;
    const bool is_between = 2 * neighbourhood.between[v] >= counts[v];
    const bool is_near =
        !is_mapped[v] && 2 * neighbourhood.near[v] >= counts[v] && has_strong_neighbour(value);
    if (!is_between && !is_near) continue;
    const std::size_t first = neighbourhood.first[v];
    blended.push_back({static_cast<std::uint8_t>(value), counts[v],
                       static_cast<std::uint32_t>(first % mask.width),
                       static_cast<std::uint32_t>(first / mask.width)});
  }
  return blended;
}

std::vector<MaskSpeck> find_specks(const Mask& mask, const std::vector<BlendedValue>& blended) {
  const std::uint64_t most =
      std::min<std::uint64_t>(kMaxSpeckPixels, mask.tags.size() / kPixelsPerSpeckPixel);
  std::array<bool, kMaskValues> is_blended{};
  for (const BlendedValue& value : blended) is_blended[value.value] = true;
  std::vector<MaskSpeck> specks;
  std::vector<bool> is_visited(mask.tags.size());
  std::vector<std::size_t> queue;
  for (std::size_t start = 0; start < mask.tags.size(); ++start) {
    if (is_visited[start]) continue;
    const std::uint8_t tag = mask.tags[start];
    is_visited[start] = true;
    queue.assign(1, start);
    std::uint64_t count = 0;
    while (!queue.empty()) {
      const std::size_t pixel = queue.back();
      queue.pop_back();
      ++count;
      for_each_neighbour(mask, static_cast<std::uint32_t>(pixel % mask.width),
                         static_cast<std::uint32_t>(pixel / mask.width), [&](std::size_t neighbour) {
                           if (is_visited[neighbour] || mask.tags[neighbour] != tag) return;
                           is_visited[neighbour] = true;
                           queue.push_back(neighbour);
                         });
    }
    if (count > most || is_blended[tag]) continue;
    specks.push_back({tag, static_cast<std::uint32_t>(start % mask.width),
                      static_cast<std::uint32_t>(start / mask.width), count});
  }
  std::ranges::stable_sort(specks, {}, &MaskSpeck::tag);
  return specks;
}

// Whether a size is another one scaled, its sides rounded to whole pixels.
bool is_scaled(std::uint64_t width, std::uint64_t height, std::uint64_t other_width,
               std::uint64_t other_height) {
  const std::uint64_t a = width * other_height;
  const std::uint64_t b = height * other_width;
  return (a > b ? a - b : b - a) <= std::max({width, height, other_width, other_height}) / 2;
}

}  // namespace

void check_size(const Mask& mask, const CaptureFormat& format_known, const std::string& title) {
  const Shape& capture = format_known.shape;
  if (mask.width == capture.width && mask.height == capture.height) return;
  const bool is_upright = is_scaled(mask.width, mask.height, capture.width, capture.height);
  const bool is_turned = !is_upright && is_scaled(mask.width, mask.height, capture.height, capture.width);
  std::string way_out = "both must have the same size";
  if (mask.width == capture.height && mask.height == capture.width) {
    way_out = "turn it by 90 degrees";
  } else if (is_turned || is_upright) {
    way_out = format("{}scale it to {} x {}{}", is_turned ? "turn it by 90 degrees and " : "", capture.width,
                     capture.height,
                     mask.is_soft() ? "" : " without smoothing (nearest neighbour), which would make new values");
  }
  throw InputError(title + format("the mask is {} x {} pixels, the capture {} x {}; {}", mask.width, mask.height,
                                  capture.width, capture.height, way_out),
                   size_advice(mask.width, mask.height, format_known));
}

Advice size_advice(std::uint32_t width, std::uint32_t height, const CaptureFormat& capture) {
  const Shape &own = capture.shape, shown = capture.shown_shape();
  if (shown != own && width == shown.width && height == shown.height)
    return {"; these are the picture's square pixels: draw on one that is written with `keep-pixels`"};
  const bool is_part = (width <= own.width && height <= own.height) || (width >= own.width && height >= own.height);
  if (!is_part || is_scaled(width, height, own.width, own.height)) return {};
  return {"; draw on a picture of the same part (`crop`), and keep the size of what is aligned with `unseen hold`"};
}

std::string unmapped_mistake(const std::array<std::uint64_t, kMaskValues>& pixels_per_tag,
                             const std::array<bool, kMaskValues>& is_mapped) {
  constexpr std::size_t kMaxShown = 20;
  std::string values;
  std::size_t count = 0;
  for (std::uint32_t tag = 0; tag < kMaskValues; ++tag) {
    if (pixels_per_tag[tag] == 0 || is_mapped[tag] || ++count > kMaxShown) continue;
    values += format("{}{} ({} pixels)", values.empty() ? "" : ", ", tag, pixels_per_tag[tag]);
  }
  if (values.empty()) return {};
  if (count > kMaxShown) values += format(" and {} more", count - kMaxShown);
  return format("mask values without a function: {}; add a line M<value> for each, or expose them to black",
                values);
}

MaskFlaws find_flaws(const Mask& mask, const std::array<bool, kMaskValues>& is_mapped) {
  MaskFlaws flaws;
  flaws.blended = find_blended(mask, is_mapped);
  flaws.specks = find_specks(mask, flaws.blended);
  return flaws;
}

}  // namespace nutik
