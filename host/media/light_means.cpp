#include "media/light_means.hpp"

#include <algorithm>

namespace nutik {
namespace {

constexpr std::size_t kSteps = std::size_t{1} << 16;

std::size_t step_of(double light) {
  return static_cast<std::size_t>(std::clamp(light, 0.0, 1.0) * static_cast<double>(kSteps - 1));
}

}  // namespace

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
      sums_(std::size_t{scaled.width} * scaled.channels) {
  light_ = format.transfer.light_of_codes(format.white_code);
  thresholds_ = format.transfer.code_thresholds(format.white_code);
  std::uint32_t code = 0;
  for (std::size_t step = 0; step <= kSteps; ++step) {
    const double light = static_cast<double>(step) / static_cast<double>(kSteps - 1);
    while (code < format.white_code && thresholds_[code + 1] <= light) ++code;
    first_code_.push_back(code);
  }
}

// The last one that begins no later.
std::uint32_t LightMeans::code_of(double light) const {
  const std::size_t step = step_of(light);
  const auto begin = thresholds_.begin() + 1;
  const auto after = std::upper_bound(begin + first_code_[step], begin + first_code_[step + 1], light);
  return static_cast<std::uint32_t>(after - begin);
}

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
            if (*value >= light_.size()) throw CodeAboveWhite(*value);
            sum += share * light_[*value];
            value += channels;
          }
          sums_[x * channels + channel] += span.shares[r] * sum;
        }
      }
    }
    for (const double light : sums_) *scaled++ = static_cast<Code>(code_of(light));
  }
}

void LightMeans::take(std::span<const std::byte> raster, std::span<std::byte> scaled) {
  if (code_bytes_ == 1) {
    take_codes(reinterpret_cast<const std::uint8_t*>(raster.data()),
               reinterpret_cast<std::uint8_t*>(scaled.data()));
  } else {
    take_codes(reinterpret_cast<const std::uint16_t*>(raster.data()),
               reinterpret_cast<std::uint16_t*>(scaled.data()));
  }
}

}  // namespace nutik
