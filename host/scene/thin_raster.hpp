// Every so many pixels of a row and every so many rows of a sample, for what needs no more of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "capture/picture.hpp"
#include "imev/sample_cursor.hpp"

namespace nutik {

class ThinRaster {
 public:
  ThinRaster(const CaptureFormat& capture, std::uint32_t step);

  [[nodiscard]] const CaptureFormat& format() const { return thin_; }
  [[nodiscard]] std::span<const std::byte> raster() const { return raster_; }

  // Takes what tiles hold.
  void take(const SampleCursor& held, std::span<const std::uint32_t> tiles);

 private:
  template <typename Code, std::size_t kChannels>
  void take(const SampleCursor& held, std::span<const std::uint32_t> tiles);

  CaptureFormat thin_;
  Shape shape_;  // of the capture
  TileGrid grid_;
  std::uint32_t step_;
  std::vector<std::byte> raster_;
};

}  // namespace nutik
