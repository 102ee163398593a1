#include "align/light_warp.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "align/camera_path.hpp"
#include "system/parallel.hpp"
#include "system/simd_clones.hpp"

namespace nutik {
namespace {

constexpr std::uint32_t kPixelsAtOnce = 128;
constexpr std::size_t kTaps = 4;
constexpr std::uint32_t kMaxChannels = 3;
// Pictures are moved in parts whose light stays in a core's cache. What a part comes from reaches a little further, and
// of steep warps much further: then the part is halved.
constexpr std::uint32_t kPartWidth = 256, kPartHeight = 64;
constexpr std::uint64_t kMaxBoxPixels = std::uint64_t{2} * kPartWidth * kPartHeight;

// Behind the values that are asked for there may be as many more as make a vector whole.
constexpr std::size_t kLightsInVector = 16, kCodesInVector = 64;
constexpr std::size_t whole_vectors(std::size_t count, std::size_t in_vector) {
  return (count + in_vector - 1) / in_vector * in_vector;
}

constexpr std::size_t kTapsOfPixels = kPixelsAtOnce + kLightsInVector;

template <typename Value>
using OfPixels = std::array<Value, kTapsOfPixels>;

// What taps reach: beyond a picture's sides its outermost pixels go on.
struct Box {
  std::int32_t x = 0, y = 0;
  std::uint32_t width = 0, height = 0;
  [[nodiscard]] std::uint64_t pixels() const { return std::uint64_t{width} * height; }
};

using OfTaps = float[kTaps * kTapsOfPixels];

// Pixels side by side in a row: where in a plane of the box their first taps are, and what each tap counts.
struct Taps {
  std::uint32_t first[kPixelsAtOnce];
  OfTaps x = {}, y = {};
};

// The cubic's taps at -1, 0, 1 and 2 for places t behind 0, 0 <= t < 1.
[[gnu::always_inline]] inline void set_cubic(OfTaps& taps, std::size_t i, double t) {
  const auto u = static_cast<float>(t);
  taps[i] = ((-0.5f * u + 1) * u - 0.5f) * u;
  taps[kTapsOfPixels + i] = (1.5f * u - 2.5f) * u * u + 1;
  taps[2 * kTapsOfPixels + i] = ((-1.5f * u + 2) * u + 0.5f) * u;
  taps[3 * kTapsOfPixels + i] = (0.5f * u - 0.5f) * u * u;
}

// No branches: compilers make vectors of it.
[[gnu::always_inline]] inline double within(double value, double low, double high) {
  value = value > low ? value : low;
  return value < high ? value : high;
}

// A steep warp leads further beyond a side than what is seen does.
[[gnu::always_inline]] inline Place beside(const Place& place, const Shape& shape) {
  return {within(place.x, -0.5, shape.width - 0.5), within(place.y, -0.5, shape.height - 0.5)};
}

template <typename PlaceOf>
[[gnu::always_inline]] inline void set_taps_at(PlaceOf place_of, std::uint32_t count, const Shape& shape,
                                               const Box& box, Taps& __restrict taps) {
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(count); ++i) {
    const Place place = beside(place_of(i), shape);
    const auto right = static_cast<std::int32_t>(place.x + 1), down = static_cast<std::int32_t>(place.y + 1);
    set_cubic(taps.x, static_cast<std::size_t>(i), place.x - (right - 1));
    set_cubic(taps.y, static_cast<std::size_t>(i), place.y - (down - 1));
    // The tap at -1.
    taps.first[i] =
        static_cast<std::uint32_t>(down - 2 - box.y) * box.width + static_cast<std::uint32_t>(right - 2 - box.x);
  }
}

NUTIK_SIMD_CLONES void set_taps(Warp warp, std::uint32_t x, std::uint32_t y, std::uint32_t count, const Shape& shape,
                                const Box& box, Taps& __restrict taps) {
  const auto left = static_cast<std::int32_t>(x);
  const double row = y;
  const auto& m = warp.m;
  if (m[6] == 0 && m[7] == 0 && m[8] == 1) {  // there is nothing to divide by, which takes longest
    const auto at = [&](std::int32_t i) __attribute__((always_inline)) {
      return Place{m[0] * (left + i) + m[1] * row + m[2], m[3] * (left + i) + m[4] * row + m[5]};
    };
    set_taps_at(at, count, shape, box, taps);
  } else {
    const auto at = [&](std::int32_t i) __attribute__((always_inline)) { return warp.at(left + i, row); };
    set_taps_at(at, count, shape, box, taps);
  }
}

// The light of pixels whose taps lie side by side, too, and of others behind them, so that vectors are whole.
NUTIK_SIMD_CLONES void add_taps(const float* __restrict from, std::size_t stride, const Taps& taps, std::size_t first,
                                std::size_t end, float* __restrict lights) {
  const std::size_t count = whole_vectors(end - first, kLightsInVector);
  const float *const row1 = from + stride, *const row2 = row1 + stride, *const row3 = row2 + stride;
  const float *const x = taps.x + first, *const y = taps.y + first;
  float* const to = lights + first;
  const auto along = [x](const float* row, std::size_t i) __attribute__((always_inline)) {
    return x[i] * row[i] + x[kTapsOfPixels + i] * row[i + 1] + x[2 * kTapsOfPixels + i] * row[i + 2] +
           x[3 * kTapsOfPixels + i] * row[i + 3];
  };
  for (std::size_t i = 0; i < count; ++i) {
    to[i] = y[i] * along(from, i) + y[kTapsOfPixels + i] * along(row1, i) + y[2 * kTapsOfPixels + i] * along(row2, i) +
            y[3 * kTapsOfPixels + i] * along(row3, i);
  }
}

// The end of those from `first` on whose taps lie side by side.
std::uint32_t end_of_run(const Taps& taps, std::uint32_t first, std::uint32_t count) {
  std::uint32_t end = first + 1;
  while (end < count && taps.first[end] == taps.first[end - 1] + 1) ++end;
  return end;
}

// The least and the largest code that the taps see, and of more behind them: as of light, of which a vector holds less.
template <typename Code>
[[gnu::always_inline]] inline void find_limits(const Code* __restrict from, std::size_t stride, std::size_t channels,
                                               std::size_t count, Code* __restrict least, Code* __restrict most) {
  count = whole_vectors(count, kCodesInVector);
  for (std::size_t i = 0; i < count; ++i) {
    Code low = from[i], high = from[i];
    for (std::size_t row = 0; row < kTaps; ++row) {
      for (std::size_t column = 0; column < kTaps; ++column) {
        const Code code = from[row * stride + column * channels + i];
        low = low < code ? low : code;
        high = high > code ? high : code;
      }
    }
    least[i] = low;
    most[i] = high;
  }
}

NUTIK_SIMD_CLONES void set_limits(const std::uint8_t* from, std::size_t stride, std::size_t channels, std::size_t count,
                                  std::uint8_t* least, std::uint8_t* most) {
  find_limits(from, stride, channels, count, least, most);
}

NUTIK_SIMD_CLONES void set_limits(const std::uint16_t* from, std::size_t stride, std::size_t channels,
                                  std::size_t count, std::uint16_t* least, std::uint16_t* most) {
  find_limits(from, stride, channels, count, least, most);
}

template <std::uint32_t channels, typename Code>
void interleave(const OfPixels<std::uint32_t>* codes, std::uint32_t count, const Code* __restrict least,
                const Code* __restrict most, Code* __restrict to) {
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t channel = 0; channel < channels; ++channel) {
      to[i * channels + channel] = static_cast<Code>(codes[channel].data()[i]);
    }
  }
  for (std::uint32_t i = 0; i < count * channels; ++i) {
    const Code code = to[i] > least[i] ? to[i] : least[i];
    to[i] = code < most[i] ? code : most[i];
  }
}

}  // namespace

LightWarp::LightWarp(const CaptureFormat& format, const Rectangle& area)
    : format_(format), area_(area), tables_(format.transfer, format.white_code) {}

std::uint64_t LightWarp::bytes(const CaptureFormat& format) {
  return std::uint64_t{core_count()} * kMaxBoxPixels * format.shape.channels *
         (sizeof(float) + format.code_bytes);
}

// Moves one part of a picture after another.
template <typename Code>
class LightWarp::Part {
 public:
  Part(const LightWarp& whole, const Warp& warp, const Code* raster, Code* warped)
      : whole_(whole), warp_(warp), raster_(raster), warped_(warped) {}

  // `part` lies in the new picture.
  void move(const Rectangle& part) {
    set_spans(part);
    if (box_.pixels() <= kMaxBoxPixels) {
      if (box_.pixels() == 0) return;
      read_box();
      for (std::uint32_t row = 0; row < part.height; ++row) write_row(part.y + row, spans_[row]);
      return;
    }
    Rectangle first = part, second = part;
    if (part.width > part.height) {
      second.x += first.width /= 2;
      second.width -= first.width;
    } else {
      second.y += first.height /= 2;
      second.height -= first.height;
    }
    move(first);
    move(second);
  }

 private:
  [[nodiscard]] const Shape& shape() const { return whole_.format_.shape; }

  // What of each row is seen, and the box that it comes from: the ends of a row lie furthest out.
  void set_spans(const Rectangle& part) {
    double left = shape().width, right = -1, top = shape().height, bottom = -1;
    for (std::uint32_t row = 0; row < part.height; ++row) {
      PixelSpan span = seen_span(warp_, shape(), part.y + row);
      span.first = std::max(span.first, part.x);
      span.end = std::min(span.end, part.x + part.width);
      spans_[row] = span;
      if (span.first >= span.end) continue;
      for (const std::uint32_t x : {span.first, span.end - 1}) {
        const Place place = beside(warp_.at(x, part.y + row), shape());
        left = std::min(left, place.x);
        right = std::max(right, place.x);
        top = std::min(top, place.y);
        bottom = std::max(bottom, place.y);
      }
    }
    box_ = {};
    if (right < left) return;
    // A pixel more, for places between may be rounded otherwise.
    constexpr std::int32_t kBefore = 2, kBehind = 3;
    box_.x = static_cast<std::int32_t>(std::floor(left)) - kBefore;
    box_.y = static_cast<std::int32_t>(std::floor(top)) - kBefore;
    box_.width = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(right)) + kBehind + 1 - box_.x);
    box_.height = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(bottom)) + kBehind + 1 - box_.y);
  }

  void read_box() {
    const std::size_t channels = shape().channels, width = box_.width;
    codes_.resize(box_.pixels() * channels + kCodesInVector);
    light_.resize(box_.pixels() * channels + kLightsInVector);
    const auto last = static_cast<std::int32_t>(shape().width) - 1;
    const std::int32_t first = std::clamp(box_.x, 0, last),
                       end = std::clamp(box_.x + static_cast<std::int32_t>(width), 1, last + 1);
    for (std::uint32_t row = 0; row < box_.height; ++row) {
      const auto y = static_cast<std::size_t>(
          std::clamp(box_.y + static_cast<std::int32_t>(row), 0, static_cast<std::int32_t>(shape().height) - 1));
      const Code* const from = raster_ + y * shape().width * channels;
      Code* const codes = codes_.data() + row * width * channels;
      Code* to = codes;
      for (std::int32_t x = box_.x; x < first; ++x) to = std::copy_n(from, channels, to);
      to = std::copy(from + static_cast<std::size_t>(first) * channels, from + static_cast<std::size_t>(end) * channels,
                     to);
      while (to < codes + width * channels)
        to = std::copy_n(from + static_cast<std::size_t>(last) * channels, channels, to);
      for (std::size_t channel = 0; channel < channels; ++channel) {
        whole_.tables_.lights_of(codes + channel, channels,
                                 {light_.data() + channel * box_.pixels() + row * width, width});
      }
    }
  }

  void write_row(std::uint32_t y, const PixelSpan& span) {
    const std::size_t channels = shape().channels, stride = box_.width;
    for (std::uint32_t x = span.first; x < span.end; x += kPixelsAtOnce) {
      const std::uint32_t count = std::min(kPixelsAtOnce, span.end - x);
      set_taps(warp_, x, y, count, shape(), box_, taps_);
      for (std::uint32_t first = 0, end = 0; first < count; first = end) {
        end = end_of_run(taps_, first, count);
        const std::size_t from = taps_.first[first];
        for (std::size_t channel = 0; channel < channels; ++channel) {
          add_taps(light_.data() + channel * box_.pixels() + from, stride, taps_, first, end, lights_[channel].data());
        }
        const std::size_t values = first * channels;
        set_limits(codes_.data() + from * channels, stride * channels, channels, (end - first) * channels,
                   least_.data() + values, most_.data() + values);
      }
      for (std::size_t channel = 0; channel < channels; ++channel) {
        whole_.tables_.codes_of({lights_[channel].data(), count}, found_[channel].data());
      }
      const Rectangle& area = whole_.area_;
      Code* const to = warped_ + (std::size_t{y - area.y} * area.width + (x - area.x)) * channels;
      channels == 1 ? interleave<1>(found_.data(), count, least_.data(), most_.data(), to)
                    : interleave<kMaxChannels>(found_.data(), count, least_.data(), most_.data(), to);
    }
  }

  const LightWarp& whole_;
  const Warp& warp_;
  const Code* raster_;
  Code* warped_;
  std::array<PixelSpan, kPartHeight> spans_;
  Box box_;
  std::vector<Code> codes_;   // of the box, the channels of a pixel side by side
  std::vector<float> light_;  // of the box, a plane for each channel
  Taps taps_;
  std::array<OfPixels<float>, kMaxChannels> lights_;
  std::array<OfPixels<std::uint32_t>, kMaxChannels> found_;
  std::array<Code, kMaxChannels * kPixelsAtOnce + kCodesInVector> least_, most_;
};

void LightWarp::take(std::span<const std::byte> raster, const Warp& warp, std::span<std::byte> warped) const {
  if (format_.white_code < (1U << 8 * format_.code_bytes) - 1) {
    const std::uint32_t most = largest_code(raster, format_.code_bytes);
    if (most > format_.white_code) throw CodeAboveWhite(most);
  }
  const std::uint32_t columns = (area_.width - 1) / kPartWidth + 1, rows = (area_.height - 1) / kPartHeight + 1;
  const auto move = [&]<typename Code>(const Code* from, Code* to) {
    parallel_for_with(
        std::uint64_t{columns} * rows, [&] { return Part<Code>(*this, warp, from, to); },
        [&](std::uint64_t number, Part<Code>& part) {
          const std::uint32_t x = static_cast<std::uint32_t>(number % columns) * kPartWidth,
                              y = static_cast<std::uint32_t>(number / columns) * kPartHeight;
          part.move({area_.x + x, area_.y + y, std::min(kPartWidth, area_.width - x),
                     std::min(kPartHeight, area_.height - y)});
        });
  };
  with_codes(format_.code_bytes, raster.data(), [&]<typename Code>(const Code* codes) {
    move(codes, reinterpret_cast<Code*>(warped.data()));
  });
}

}  // namespace nutik
