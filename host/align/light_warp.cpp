#include "align/light_warp.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "align/camera_path.hpp"
#include "system/parallel.hpp"
#include "system/simd_clones.hpp"

namespace nutik {
namespace {

// Singles that differ only in their last bits, this many of them or fewer, share a cell.
constexpr std::int32_t kMaxCellBits = 15;
// Behind the place in a cell where the next code begins, and more than any place.
constexpr std::int32_t kPlaceBits = 16;
constexpr std::uint32_t kNoPlace = 0xFFFF;

// The least single that is no less than `light`: singles reach both at once.
float next_float(double light) {
  const auto near = static_cast<float>(light);
  return near < light ? std::nextafter(near, std::numeric_limits<float>::infinity()) : near;
}

template <typename Code>
std::uint32_t highest(const Code* codes, std::size_t count) {
  Code most = 0;
  for (std::size_t i = 0; i < count; ++i) most = most < codes[i] ? codes[i] : most;
  return most;
}

template <typename Code>
void look_up(const std::vector<float>& light, const Code* codes, std::size_t stride,
             std::span<float> lights) {
  if (light.size() <= std::numeric_limits<Code>::max()) {
    const std::uint32_t most = highest(codes, (lights.size() - 1) * stride + 1);
    if (most >= light.size()) throw CodeAboveWhite(most);
  }
  const float* const table = light.data();
  float* const to = lights.data();
  for (std::size_t i = 0; i < lights.size(); ++i) to[i] = table[codes[i * stride]];
}

// Positive singles are in the order of their bits.
std::int32_t bits_of(float light) { return std::bit_cast<std::int32_t>(light); }

NUTIK_SIMD_CLONES void find_codes(const float* __restrict lights, std::size_t count,
                                  const std::uint32_t* __restrict cells, std::int32_t first_cell,
                                  std::int32_t cell_bits, std::uint32_t* __restrict codes) {
  const std::int32_t places = (1 << cell_bits) - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const auto bits = __builtin_bit_cast(std::int32_t, lights[i]);
    const std::int32_t cell = bits >> cell_bits;
    const std::uint32_t found = cells[cell > first_cell ? cell - first_cell : 0];
    const bool is_next = (bits & places) >= static_cast<std::int32_t>(found & kNoPlace);
    codes[i] = (found >> kPlaceBits) + (is_next ? 1 : 0);
  }
}

constexpr std::uint32_t kRowsAtOnce = 16;
constexpr std::uint32_t kTaps = 4;
constexpr std::uint32_t kBorder = 2;  // what the taps of a place at a picture's side reach beyond it
constexpr std::uint32_t kPixelsAtOnce = 128;
constexpr std::uint32_t kMaxChannels = 3;

// A plane of light, and round it its outermost pixels once more for each of the border's.
std::size_t stride_of(const Shape& shape) { return std::size_t{shape.width} + 2 * kBorder; }
std::size_t plane_of(const Shape& shape) {
  return stride_of(shape) * (std::size_t{shape.height} + 2 * kBorder);
}

template <typename Value>
using OfPixels = std::array<Value, kPixelsAtOnce>;

// Pixels side by side in a row: where in a plane their first taps are, and what each tap counts.
struct Taps {
  std::uint32_t first[kPixelsAtOnce];
  float x[kTaps][kPixelsAtOnce], y[kTaps][kPixelsAtOnce];
};

// The cubic's taps at -1, 0, 1 and 2 for places t behind 0, 0 <= t < 1.
[[gnu::always_inline]] inline void set_cubic(float (&taps)[kTaps][kPixelsAtOnce], std::int32_t i, double t) {
  const auto u = static_cast<float>(t);
  taps[0][i] = ((-0.5f * u + 1) * u - 0.5f) * u;
  taps[1][i] = (1.5f * u - 2.5f) * u * u + 1;
  taps[2][i] = ((-1.5f * u + 2) * u + 0.5f) * u;
  taps[3][i] = (0.5f * u - 0.5f) * u * u;
}

// No branches: compilers make vectors of it.
[[gnu::always_inline]] inline double within(double value, double low, double high) {
  value = value > low ? value : low;
  return value < high ? value : high;
}

template <typename PlaceOf>
[[gnu::always_inline]] inline void set_taps_at(PlaceOf place_of, std::uint32_t count, const Shape& shape,
                                               Taps& __restrict taps) {
  const auto stride = static_cast<std::uint32_t>(stride_of(shape));
  const double right_side = shape.width - 0.5, bottom = shape.height - 0.5;
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(count); ++i) {
    const Place place = place_of(i);
    // A steep warp may lead further beyond a side than the border reaches.
    const double px = within(place.x, -0.5, right_side), py = within(place.y, -0.5, bottom);
    const auto right = static_cast<std::int32_t>(px + 1), down = static_cast<std::int32_t>(py + 1);
    set_cubic(taps.x, i, px - (right - 1));
    set_cubic(taps.y, i, py - (down - 1));
    // The tap at -1 is right - 2, in a plane that begins at -kBorder.
    taps.first[i] = static_cast<std::uint32_t>(down) * stride + static_cast<std::uint32_t>(right);
  }
}

NUTIK_SIMD_CLONES void set_taps(Warp warp, std::uint32_t x, std::uint32_t y, std::uint32_t count,
                                const Shape& shape, Taps& __restrict taps) {
  const auto left = static_cast<std::int32_t>(x);
  const double row = y;
  const auto& m = warp.m;
  if (m[6] == 0 && m[7] == 0 && m[8] == 1) {  // there is nothing to divide by, which takes longest
    const auto at = [&](std::int32_t i) __attribute__((always_inline)) {
      return Place{m[0] * (left + i) + m[1] * row + m[2], m[3] * (left + i) + m[4] * row + m[5]};
    };
    set_taps_at(at, count, shape, taps);
  } else {
    set_taps_at([&](std::int32_t i) __attribute__((always_inline)) { return warp.at(left + i, row); }, count, shape, taps);
  }
}

// The light of pixels whose taps lie side by side, too.
NUTIK_SIMD_CLONES void add_taps(const float* __restrict plane, std::size_t stride, const Taps& taps,
                                std::uint32_t first, std::uint32_t end, float* __restrict lights) {
  for (std::uint32_t i = first; i < end; ++i) {
    const float* const from = plane + taps.first[first] + (i - first);
    float sum = 0;
    for (std::uint32_t row = 0; row < kTaps; ++row) {
      float along = 0;
      for (std::uint32_t column = 0; column < kTaps; ++column) {
        along += taps.x[column][i] * from[row * stride + column];
      }
      sum += taps.y[row][i] * along;
    }
    sum = sum < 0 ? 0 : sum;
    lights[i] = sum > 1 ? 1 : sum;
  }
}

// The end of those from `first` on whose taps lie side by side.
std::uint32_t end_of_run(const Taps& taps, std::uint32_t first, std::uint32_t count) {
  std::uint32_t end = first + 1;
  while (end < count && taps.first[end] == taps.first[end - 1] + 1) ++end;
  return end;
}

// Keeps values of pixels within what the taps see, in codes: as in light, of which fewer fit in a vector.
template <typename Code>
[[gnu::always_inline]] inline void keep_within(const Code* __restrict from, std::size_t stride, std::size_t channels,
                                               std::size_t count, Code* __restrict codes) {
  for (std::size_t i = 0; i < count; ++i) {
    Code least = from[i], most = from[i];
    for (std::size_t row = 0; row < kTaps; ++row) {
      for (std::size_t column = 0; column < kTaps; ++column) {
        const Code code = from[row * stride + column * channels + i];
        least = least < code ? least : code;
        most = most > code ? most : code;
      }
    }
    const Code bright = codes[i] > least ? codes[i] : least;
    codes[i] = bright < most ? bright : most;
  }
}

NUTIK_SIMD_CLONES void limit(const std::uint8_t* from, std::size_t stride, std::size_t channels, std::size_t count,
                             std::uint8_t* codes) {
  keep_within(from, stride, channels, count, codes);
}

NUTIK_SIMD_CLONES void limit(const std::uint16_t* from, std::size_t stride, std::size_t channels, std::size_t count,
                             std::uint16_t* codes) {
  keep_within(from, stride, channels, count, codes);
}

template <std::uint32_t channels, typename Code>
void interleave(const OfPixels<std::uint32_t>* codes, std::uint32_t count, Code* to) {
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t channel = 0; channel < channels; ++channel) {
      *to++ = static_cast<Code>(codes[channel].data()[i]);
    }
  }
}

}  // namespace

LightTables::LightTables(const Transfer& transfer, std::uint32_t white_code) {
  for (const double light : transfer.light_of_codes(white_code)) light_.push_back(static_cast<float>(light));
  // What is darker than the least normal single is black.
  std::vector<std::int32_t> begins;
  const std::int32_t least = bits_of(std::numeric_limits<float>::min());
  for (const double light : transfer.code_thresholds(white_code)) {
    begins.push_back(std::max(bits_of(next_float(light)), least));
  }
  cell_bits_ = kMaxCellBits;
  for (std::uint32_t code = 2; code <= white_code; ++code) {
    if (begins[code - 1] == least) continue;
    while (cell_bits_ > 0 && begins[code - 1] >> cell_bits_ == begins[code] >> cell_bits_) --cell_bits_;
  }
  first_cell_ = (begins[1] >> cell_bits_) - 1;  // is black
  std::uint32_t code = 0;
  for (std::int32_t cell = first_cell_; cell <= bits_of(1) >> cell_bits_; ++cell) {
    const std::int32_t start = cell << cell_bits_;
    while (code < white_code && begins[code + 1] <= start) ++code;
    const std::int64_t place = code < white_code ? std::int64_t{begins[code + 1]} - start : kNoPlace;
    cells_.push_back(code << kPlaceBits | static_cast<std::uint32_t>(std::min<std::int64_t>(place, kNoPlace)));
  }
}

void LightTables::lights_of(const std::uint8_t* codes, std::size_t stride, std::span<float> lights) const {
  look_up(light_, codes, stride, lights);
}

void LightTables::lights_of(const std::uint16_t* codes, std::size_t stride, std::span<float> lights) const {
  look_up(light_, codes, stride, lights);
}

void LightTables::codes_of(std::span<const float> lights, std::uint32_t* codes) const {
  find_codes(lights.data(), lights.size(), cells_.data(), first_cell_, cell_bits_, codes);
}

LightWarp::LightWarp(const CaptureFormat& format, const Rectangle& area)
    : format_(format),
      area_(area),
      tables_(format.transfer, format.white_code),
      light_(plane_of(format.shape) * format.shape.channels),
      codes_(light_.size() * format.code_bytes) {}

std::uint64_t LightWarp::bytes(const CaptureFormat& format) {
  return plane_of(format.shape) * format.shape.channels * (sizeof(float) + format.code_bytes);
}

template <typename Code>
void LightWarp::read_light(const Code* raster) {
  const Shape& shape = format_.shape;
  const std::size_t stride = stride_of(shape), channels = shape.channels, values = shape.width * channels;
  parallel_for(shape.height + 2 * kBorder, [&](std::uint64_t row) {
    const std::uint64_t y = std::clamp<std::uint64_t>(row, kBorder, shape.height - 1 + kBorder) - kBorder;
    const Code* const from = raster + y * values;
    Code* const codes = codes_of_planes<Code>() + row * stride * channels;
    std::copy_n(from, values, codes + kBorder * channels);
    for (std::size_t i = 0; i < kBorder; ++i) {
      std::copy_n(from, channels, codes + i * channels);
      std::copy_n(from + values - channels, channels, codes + (stride - 1 - i) * channels);
    }
    for (std::uint32_t channel = 0; channel < channels; ++channel) {
      float* const to = light_.data() + channel * plane_of(shape) + row * stride;
      tables_.lights_of(from + channel, channels, {to + kBorder, shape.width});
      std::fill_n(to, kBorder, to[kBorder]);
      std::fill_n(to + kBorder + shape.width, kBorder, to[kBorder + shape.width - 1]);
    }
  });
}

template <typename Code>
void LightWarp::write_row(const Warp& warp, std::uint32_t row, Code* warped) {
  const std::uint32_t channels = format_.shape.channels, y = area_.y + row;
  const std::size_t stride = stride_of(format_.shape);
  PixelSpan seen = seen_span(warp, format_.shape, y);
  seen.first = std::max(seen.first, area_.x);
  seen.end = std::min(seen.end, area_.x + area_.width);
  Taps taps;
  std::array<OfPixels<float>, kMaxChannels> lights;
  std::array<OfPixels<std::uint32_t>, kMaxChannels> codes;
  OfPixels<std::uint32_t> ends;  // of runs
  for (std::uint32_t x = seen.first; x < seen.end; x += kPixelsAtOnce) {
    const std::uint32_t count = std::min(kPixelsAtOnce, seen.end - x);
    set_taps(warp, x, y, count, format_.shape, taps);
    std::size_t runs = 0;
    for (std::uint32_t first = 0, end = 0; first < count; first = end) {
      ends[runs++] = end = end_of_run(taps, first, count);
      for (std::uint32_t channel = 0; channel < channels; ++channel) {
        add_taps(light_.data() + channel * plane_of(format_.shape), stride, taps, first, end,
                 lights[channel].data());
      }
    }
    for (std::uint32_t channel = 0; channel < channels; ++channel) {
      tables_.codes_of({lights[channel].data(), count}, codes[channel].data());
    }
    Code* const to = warped + (std::size_t{row} * area_.width + (x - area_.x)) * channels;
    channels == 1 ? interleave<1>(codes.data(), count, to)
                  : interleave<kMaxChannels>(codes.data(), count, to);
    for (std::uint32_t run = 0, first = 0; run < runs; first = ends[run++]) {
      limit(codes_of_planes<Code>() + std::size_t{taps.first[first]} * channels, stride * channels, channels,
            std::size_t{ends[run] - first} * channels, to + std::size_t{first} * channels);
    }
  }
}

void LightWarp::take(std::span<const std::byte> raster, const Warp& warp, std::span<std::byte> warped) {
  const auto move = [&]<typename Code>(const Code* from, Code* to) {
    read_light(from);
    parallel_for((area_.height - 1) / kRowsAtOnce + 1, [&](std::uint64_t strip) {
      const auto first = static_cast<std::uint32_t>(strip) * kRowsAtOnce;
      const std::uint32_t end = std::min(first + kRowsAtOnce, area_.height);
      for (std::uint32_t row = first; row < end; ++row) write_row(warp, row, to);
    });
  };
  if (format_.code_bytes == 1) {
    move(reinterpret_cast<const std::uint8_t*>(raster.data()),
         reinterpret_cast<std::uint8_t*>(warped.data()));
  } else {
    move(reinterpret_cast<const std::uint16_t*>(raster.data()),
         reinterpret_cast<std::uint16_t*>(warped.data()));
  }
}

}  // namespace nutik
