// Pictures of fewer pixels, each a mean of light.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "capture/light_codes.hpp"
#include "capture/picture.hpp"

namespace nutik {

class LightMeans {
 public:
  // The rectangle is one of rasters of this format; `scaled` has no side that is longer than its.
  LightMeans(const CaptureFormat& format, const Rectangle& area, const Shape& scaled);

  // `scaled` has codes of the same kind. Throws CodeAboveWhite.
  void take(std::span<const std::byte> raster, std::span<std::byte> scaled);

 private:
  // What a new pixel covers along a side: pixels from `first` on, each by its share of the length.
  struct Span {
    std::uint32_t first;
    std::vector<double> shares;
  };
  static std::vector<Span> spans(std::uint32_t length, std::uint32_t parts);

  template <typename Code>
  void take_codes(const Code* raster, Code* scaled);

  Shape shape_;
  Rectangle area_;
  Shape scaled_;
  std::uint32_t code_bytes_;
  std::vector<Span> columns_, rows_;
  LightCodes codes_;
  std::vector<double> sums_;  // of a row of new pixels
};

}  // namespace nutik
