#include "scene/thin_raster.hpp"

#include <algorithm>

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
  for (const std::uint32_t tile : tiles) {
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
  }
}

}  // namespace nutik
