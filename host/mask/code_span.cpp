#include "mask/code_span.hpp"

#include <algorithm>
#include <cstdlib>

namespace nutik {
namespace {

// Calls visit(codes) with a picture's codes, as they are held.
template <typename Visit>
void with_codes(const Picture& picture, Visit visit) {
  if (picture.type == ValueType::code8) {
    visit(picture.values<std::uint8_t>());
  } else {
    visit(picture.values<std::uint16_t>());
  }
}

}  // namespace

CodeSpan::CodeSpan(const CaptureFormat& capture, SampleRange samples)
    : capture_(capture),
      samples_(samples),
      min_(capture.shape.value_count(), 0xFFFF),
      max_(capture.shape.value_count(), 0) {}

void CodeSpan::add(const BlockView& block) {
  const SampleRange held = block.extent().range();
  if (held.last <= samples_.first || held.first >= samples_.last) return;
  const TileGrid grid(capture_.shape);
  const std::uint32_t channels = capture_.shape.channels;
  std::vector<ChangeRecord> history;
  std::uint64_t pixel = 0;
  for (std::uint32_t y = 0; y < capture_.shape.height; ++y) {
    for (std::uint32_t x = 0; x < capture_.shape.width; ++x, ++pixel) {
      block.read_history(grid.tile_of(x, y), TileGrid::lane_of(x, y), history);
      for (std::size_t r = 0; r < history.size(); ++r) {
        const std::uint64_t from = held.first + history[r].sample;
        const std::uint64_t until = r + 1 < history.size() ? held.first + history[r + 1].sample : held.last;
        if (until <= samples_.first || from >= samples_.last) continue;
        for (std::uint32_t channel = 0; channel < channels; ++channel) {
          std::uint16_t& least = min_[pixel * channels + channel];
          std::uint16_t& most = max_[pixel * channels + channel];
          least = std::min(least, history[r].codes[channel]);
          most = std::max(most, history[r].codes[channel]);
        }
      }
    }
  }
}

std::vector<std::uint32_t> CodeSpan::spans() const {
  const std::uint32_t channels = capture_.shape.channels;
  std::vector<std::uint32_t> spans(capture_.shape.pixel_count());
  for (std::size_t value = 0; value < min_.size(); ++value) {
    std::uint32_t& span = spans[value / channels];
    span = std::max<std::uint32_t>(span, max_[value] < min_[value] ? 0u : max_[value] - min_[value]);
  }
  return spans;
}

std::vector<std::uint32_t> differences(const Picture& a, const Picture& b) {
  std::vector<std::uint32_t> spans(a.shape.pixel_count());
  const std::size_t channels = a.shape.channels;
  with_codes(a, [&](auto of_a) {
    with_codes(b, [&](auto of_b) {
      for (std::size_t i = 0, pixel = 0; pixel < spans.size(); ++pixel) {
        for (const std::size_t end = i + channels; i < end; ++i) {
          const auto apart = static_cast<std::uint32_t>(std::abs(int{of_a[i]} - int{of_b[i]}));
          spans[pixel] = std::max(spans[pixel], apart);
        }
      }
    });
  });
  return spans;
}

std::uint32_t default_noise(std::vector<std::uint32_t> spans, std::uint32_t white_code) {
  const auto quarter = spans.begin() + static_cast<std::ptrdiff_t>(spans.size() / 4);
  std::nth_element(spans.begin(), quarter, spans.end());
  // Twice as much may be more than codes can differ by; what is left above it is halved then.
  const std::uint32_t most = std::min(*quarter + (white_code - *quarter) / 2, white_code - 1);
  return std::min(std::max(2 * *quarter, white_code / 16), most);
}

Region spanning_more(const Shape& shape, std::span<const std::uint32_t> spans, std::uint32_t codes) {
  Region region = Region::none(shape.width, shape.height);
  std::transform(spans.begin(), spans.end(), region.inside.begin(),
                 [&](std::uint32_t span) { return static_cast<std::uint8_t>(span > codes); });
  return region;
}

Region between(const Picture& picture, double low, double high) {
  Region region = Region::none(picture.shape.width, picture.shape.height);
  const std::uint32_t channels = picture.shape.channels;
  double brightness = 0.0;
  with_codes(picture, [&](auto codes) {
    for (std::size_t i = 0; i < codes.size(); ++i) {
      const std::size_t channel = i % channels;
      if (channel == 0) brightness = 0.0;
      brightness += channels == 1 ? codes[i] : kLuma[channel] * codes[i];
      if (channel + 1 < channels) continue;
      // A colour's three products may miss the code of a grey by rounding.
      constexpr double kRounding = 1e-6;
      region.inside[i / channels] = brightness >= low - kRounding && brightness <= high + kRounding ? 1 : 0;
    }
  });
  return region;
}

}  // namespace nutik
