#include "sheet/drawings.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace nutik::sheet {
namespace {

// A pixel of the picture, and which share of an output pixel it covers.
struct Share {
  std::uint32_t place;
  double weight;
};

// For each of `count` equal parts of [0, length] the whole pixels that it overlaps; weights add up to 1.
std::vector<std::vector<Share>> shares(std::uint32_t length, std::uint32_t count) {
  std::vector<std::vector<Share>> result(count);
  const double size = static_cast<double>(length) / count;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double from = i * size;
    const double until = std::min<double>((i + 1) * size, length);
    for (auto place = static_cast<std::uint32_t>(from); place < until && place < length; ++place) {
      const double overlap = std::min<double>(until, place + 1.0) - std::max<double>(from, place);
      if (overlap > 0.0) result[i].push_back({place, overlap / (until - from)});
    }
  }
  return result;
}

std::uint32_t code_at(const Picture& picture, std::uint64_t value) {
  return picture.type == ValueType::code8 ? picture.values<std::uint8_t>()[value]
                                          : picture.values<std::uint16_t>()[value];
}

}  // namespace

Picture thumbnail(const Picture& picture, std::uint32_t width, std::uint32_t height) {
  const std::uint32_t channels = picture.shape.channels;
  const Transfer srgb = Transfer::srgb();
  const std::vector<double> light = picture.transfer.value_or(srgb).light_of_all_codes(
      picture.white_code, static_cast<std::uint32_t>(value_bytes(picture.type)));
  const auto columns = shares(picture.shape.width, width);
  const auto rows = shares(picture.shape.height, height);
  Picture small({width, height, channels}, ValueType::code8, 255);
  small.transfer = srgb;
  const auto codes = small.values<std::uint8_t>();
  std::vector<double> sums(std::size_t{width} * channels);
  for (std::uint32_t y = 0; y < height; ++y) {
    std::fill(sums.begin(), sums.end(), 0.0);
    for (const Share& row : rows[y]) {
      for (std::uint32_t x = 0; x < width; ++x) {
        for (const Share& column : columns[x]) {
          const std::uint64_t first =
              (std::uint64_t{row.place} * picture.shape.width + column.place) * channels;
          for (std::uint32_t channel = 0; channel < channels; ++channel) {
            sums[std::size_t{x} * channels + channel] +=
                row.weight * column.weight * light[code_at(picture, first + channel)];
          }
        }
      }
    }
    std::transform(
        sums.begin(), sums.end(), codes.begin() + static_cast<std::ptrdiff_t>(y * sums.size()),
        [&](double sum) {
          return static_cast<std::uint8_t>(std::lround(255 * srgb.fraction_of(std::min(sum, 1.0))));
        });
  }
  return small;
}

Picture fitted_thumbnail(const Picture& picture, const Shape& shown, std::uint32_t side) {
  const double scale = std::min(1.0, static_cast<double>(side) / std::max(shown.width, shown.height));
  const auto pixels = [&](std::uint32_t length) {
    return static_cast<std::uint32_t>(std::max(1L, std::lround(scale * length)));
  };
  return thumbnail(picture, pixels(shown.width), pixels(shown.height));
}

}  // namespace nutik::sheet
