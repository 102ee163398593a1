#include "media/light_means.hpp"

#include <algorithm>

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

LightMeans::LightMeans(const CaptureFormat& format, const Rectangle& area, const Shape& scaled)
    : shape_(format.shape),
      area_(area),
      scaled_(scaled),
      code_bytes_(format.code_bytes),
      columns_(spans(area.width, scaled.width)),
      rows_(spans(area.height, scaled.height)),
      codes_(format.transfer, format.white_code),
      sums_(std::size_t{scaled.width} * scaled.channels) {}

template <typename Code>
void LightMeans::take_codes(const Code* raster, Code* scaled) {
  const std::uint32_t channels = shape_.channels;
  for (const Span& span : rows_) {
    std::fill(sums_.begin(), sums_.end(), 0.0);
    for (std::size_t r = 0; r < span.shares.size(); ++r) {
      const std::size_t y = std::size_t{area_.y} + span.first + r;
      const Code* const row = raster + (y * shape_.width + area_.x) * channels;
      for (std::size_t x = 0; x < columns_.size(); ++x) {
        const Span& column = columns_[x];
        for (std::uint32_t channel = 0; channel < channels; ++channel) {
          double sum = 0;
          const Code* value = row + std::size_t{column.first} * channels + channel;
          for (const double share : column.shares) {
            sum += share * codes_.light_of(*value);
            value += channels;
          }
          sums_[x * channels + channel] += span.shares[r] * sum;
        }
      }
    }
    for (const double light : sums_) *scaled++ = static_cast<Code>(codes_.code_of(light));
  }
}

void LightMeans::take(std::span<const std::byte> raster, std::span<std::byte> scaled) {
  with_codes(code_bytes_, raster.data(), [&]<typename Code>(const Code* codes) {
    take_codes(codes, reinterpret_cast<Code*>(scaled.data()));
  });
}

}  // namespace nutik
