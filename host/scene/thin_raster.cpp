#include "scene/thin_raster.hpp"

#include <algorithm>
#include <cstring>

namespace nutik {

ThinRaster::ThinRaster(const CaptureFormat& capture, std::uint32_t step)
    : thin_(capture), shape_(capture.shape), grid_(capture.shape), step_(step) {
  thin_.shape.width = (shape_.width - 1) / step + 1;
  thin_.shape.height = (shape_.height - 1) / step + 1;
  raster_.resize(thin_.sample_bytes());
}

void ThinRaster::take(const SampleCursor& held, std::span<const std::uint32_t> tiles) {
  const std::size_t bytes = thin_.code_bytes, channels = shape_.channels;
  const auto first_from = [&](std::uint32_t pixel) { return (pixel + step_ - 1) / step_ * step_; };
  for (const std::uint32_t tile : tiles) {
    const std::uint32_t left = tile % grid_.columns() * kTileSide, top = tile / grid_.columns() * kTileSide;
    const std::uint32_t right = std::min(left + kTileSide, shape_.width);
    const std::uint32_t bottom = std::min(top + kTileSide, shape_.height);
    const std::byte* const codes = held.codes(tile);
    for (std::uint32_t y = first_from(top); y < bottom; y += step_) {
      for (std::uint32_t x = first_from(left); x < right; x += step_) {
        const std::size_t pixel = std::size_t{y / step_} * thin_.shape.width + x / step_;
        const std::size_t lane = TileGrid::lane_of(x, y);
        for (std::size_t channel = 0; channel < channels; ++channel) {
          std::memcpy(&raster_[(pixel * channels + channel) * bytes],
                      codes + (channel * kTilePixels + lane) * bytes, bytes);
        }
      }
    }
  }
}

}  // namespace nutik
