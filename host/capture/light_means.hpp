// Pictures of another size, each pixel of which has the mean light of the area that it covers.
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
  // The rectangle is one of pictures of this shape. `light` is that of their codes, `codes` are the new pictures'.
  LightMeans(const Shape& shape, const Rectangle& area, const Shape& scaled, std::vector<double> light,
             LightCodes codes);

  // Throws CodeAboveWhite for a code in the rectangle that has no light.
  void check(std::span<const std::byte> raster, std::uint32_t code_bytes) const;
  // Makes rows [first, last) of the new picture. Several threads may call it for others.
  void take(std::span<const std::byte> raster, std::uint32_t code_bytes, std::span<std::byte> scaled,
            std::uint32_t scaled_code_bytes, std::uint64_t first, std::uint64_t last) const;

 private:
  // What a new pixel covers along a side: pixels from `first` on, each by its share of the length.
  struct Span {
    std::uint32_t first;
    std::vector<double> shares;
  };
  static std::vector<Span> spans(std::uint32_t length, std::uint32_t parts);
  template <std::uint32_t kChannels, typename Code>
  void add_row(const Code* row, double share_of_row, double* sums) const;

  std::uint32_t channels_;
  std::size_t row_values_, first_, area_values_;  // of the pictures: in a row, before the rectangle, in a row of it
  std::vector<Span> columns_, rows_;
  std::vector<double> light_;
  LightCodes codes_;
};

}  // namespace nutik
