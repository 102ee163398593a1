// Pictures of another size, each pixel of which has the mean light of the area that it covers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "capture/light_codes.hpp"
#include "capture/picture.hpp"

namespace nutik {

class LightMeans {
 public:
  // The rectangle is one of pictures of this shape.
  LightMeans(const Shape& shape, const Rectangle& area, const Shape& scaled);

  // light_of() gives a code's light; `codes` are the new picture's.
  template <typename Code, typename NewCode, typename LightOf>
  void take(const Code* raster, const LightOf& light_of, const LightCodes& codes, NewCode* scaled) {
    for (const Span& span : rows_) {
      std::fill(sums_.begin(), sums_.end(), 0.0);
      const Code* row = raster + first_ + std::size_t{span.first} * row_values_;
      for (const double share_of_rows : span.shares) {
        double* sum_of = sums_.data();
        for (const Span& column : columns_) {
          for (std::uint32_t channel = 0; channel < channels_; ++channel) {
            double sum = 0;
            const Code* value = row + std::size_t{column.first} * channels_ + channel;
            for (const double share : column.shares) {
              sum += share * light_of(*value);
              value += channels_;
            }
            *sum_of++ += share_of_rows * sum;
          }
        }
        row += row_values_;
      }
      for (const double light : sums_) *scaled++ = static_cast<NewCode>(codes.code_of(light));
    }
  }

  // The same of codes of one kind. Throws CodeAboveWhite.
  void take(std::span<const std::byte> raster, std::uint32_t code_bytes, const LightCodes& codes,
            std::span<std::byte> scaled) {
    with_codes(code_bytes, raster.data(), [&]<typename Code>(const Code* from) {
      take(from, [&](Code code) { return codes.light_of(code); }, codes, reinterpret_cast<Code*>(scaled.data()));
    });
  }

 private:
  // What a new pixel covers along a side: pixels from `first` on, each by its share of the length.
  struct Span {
    std::uint32_t first;
    std::vector<double> shares;
  };
  static std::vector<Span> spans(std::uint32_t length, std::uint32_t parts);

  std::uint32_t channels_;
  std::size_t row_values_, first_;  // of the pictures: in a row, and before the rectangle
  std::vector<Span> columns_, rows_;
  std::vector<double> sums_;  // of a row of new pixels
};

}  // namespace nutik
