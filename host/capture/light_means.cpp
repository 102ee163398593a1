#include "capture/light_means.hpp"

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

LightMeans::LightMeans(const Shape& shape, const Rectangle& area, const Shape& scaled)
    : channels_(shape.channels),
      row_values_(std::size_t{shape.width} * channels_),
      first_(area.y * row_values_ + std::size_t{area.x} * channels_),
      columns_(spans(area.width, scaled.width)),
      rows_(spans(area.height, scaled.height)),
      sums_(std::size_t{scaled.width} * channels_) {}

}  // namespace nutik
