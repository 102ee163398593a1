#include "capture/light_means.hpp"

#include <algorithm>
#include <utility>

namespace nutik {

std::vector<LightMeans::Span> LightMeans::spans(std::uint32_t length, std::uint32_t parts) {
  std::vector<Span> spans;
  for (std::uint64_t part = 0; part < parts; ++part) {
    // In units of a parts-th of a pixel, all borders are whole numbers.
    const std::uint64_t begin = part * length, end = (part + 1) * length;
    Span span{static_cast<std::uint32_t>(begin / parts), {}};
    for (std::uint64_t pixel = span.first; pixel * parts < end; ++pixel) {
      const std::uint64_t covered = std::min(end, (pixel + 1) * parts) - std::max(begin, pixel * parts);
      span.shares.push_back(static_cast<double>(covered) / length);
    }
    spans.push_back(std::move(span));
  }
  return spans;
}

LightMeans::LightMeans(const Shape& shape, const Rectangle& area, const Shape& scaled, std::vector<double> light,
                       LightCodes codes)
    : channels_(shape.channels),
      row_values_(std::size_t{shape.width} * channels_),
      first_(area.y * row_values_ + std::size_t{area.x} * channels_),
      area_values_(std::size_t{area.width} * channels_),
      columns_(spans(area.width, scaled.width)),
      rows_(spans(area.height, scaled.height)),
      light_(std::move(light)),
      codes_(std::move(codes)) {}

void LightMeans::check(std::span<const std::byte> raster, std::uint32_t code_bytes) const {
  if (light_.size() >> 8 * code_bytes > 0) return;
  for (const Span& span : rows_) {
    for (std::size_t row = span.first; row < span.first + span.shares.size(); ++row) {
      const std::uint32_t most = largest_code(
          raster.subspan((first_ + row * row_values_) * code_bytes, area_values_ * code_bytes), code_bytes);
      if (most >= light_.size()) throw CodeAboveWhite(most);
    }
  }
}

template <std::uint32_t kChannels, typename Code>
void LightMeans::add_row(const Code* row, double share_of_row, double* sums) const {
  const double* const light = light_.data();
  for (const Span& column : columns_) {
    const Code* const first = row + std::size_t{column.first} * kChannels;
    for (std::uint32_t channel = 0; channel < kChannels; ++channel) {
      const Code* value = first + channel;
      double sum = 0;
      for (const double share : column.shares) {
        sum += share * light[*value];
        value += kChannels;
      }
      *sums++ += share_of_row * sum;
    }
  }
}

void LightMeans::take(std::span<const std::byte> raster, std::uint32_t code_bytes, std::span<std::byte> scaled,
                      std::uint32_t scaled_code_bytes, std::uint64_t first, std::uint64_t last) const {
  std::vector<double> sums(columns_.size() * channels_);
  const auto row_of = [&]<typename Code, typename NewCode>(const Code* from, NewCode* to, const Span& rows) {
    std::ranges::fill(sums, 0.0);
    const Code* row = from + first_ + rows.first * row_values_;
    for (const double share : rows.shares) {
      channels_ == 1 ? add_row<1>(row, share, sums.data()) : add_row<3>(row, share, sums.data());
      row += row_values_;
    }
    for (const double light : sums) *to++ = static_cast<NewCode>(codes_.code_of(light));
  };
  with_codes(code_bytes, raster.data(), [&](const auto* from) {
    with_codes(scaled_code_bytes, scaled.data(), [&](auto* to) {
      for (std::uint64_t y = first; y < last; ++y) row_of(from, to + y * sums.size(), rows_[y]);
    });
  });
}

}  // namespace nutik
