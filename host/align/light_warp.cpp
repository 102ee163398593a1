#include "align/light_warp.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "align/seen_area.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

constexpr std::uint32_t kRowsAtOnce = 16;
constexpr std::size_t kTaps = 4;

// The light of a pixel's channels: those of colours side by side, so that a processor takes one step for all.
using Colour = float __attribute__((vector_size(16)));
using Grey = float;

std::size_t values_of(const Shape& shape) {
  return (shape.channels == 1 ? sizeof(Grey) : sizeof(Colour)) / sizeof(float);
}

template <typename Light>
Light light_at(const float* values) {
  Light light;
  std::memcpy(&light, values, sizeof light);
  return light;
}

// The cubic's taps at -1, 0, 1 and 2 for a place t behind 0, 0 <= t < 1.
std::array<float, kTaps> cubic_taps(double t) {
  const auto u = static_cast<float>(t);
  return {((-0.5f * u + 1) * u - 0.5f) * u, (1.5f * u - 2.5f) * u * u + 1, ((-1.5f * u + 2) * u + 0.5f) * u,
          (0.5f * u - 0.5f) * u * u};
}

// The pixels of the taps along a side; beyond the border that of the border.
std::array<std::size_t, kTaps> tap_pixels(double floor, std::uint32_t side) {
  std::array<std::size_t, kTaps> pixels{};
  for (std::size_t tap = 0; tap < kTaps; ++tap) {
    const double pixel = floor + static_cast<double>(tap) - 1;
    pixels[tap] = static_cast<std::size_t>(std::clamp(pixel, 0.0, side - 1.0));
  }
  return pixels;
}

}  // namespace

LightWarp::LightWarp(const CaptureFormat& format, const Rectangle& area)
    : format_(format),
      area_(area),
      codes_(format.transfer, format.white_code),
      light_(bytes(format) / sizeof(float)) {}

std::uint64_t LightWarp::bytes(const CaptureFormat& format) {
  return format.shape.pixel_count() * values_of(format.shape) * sizeof(float);
}

template <typename Code>
void LightWarp::read_light(const Code* raster) {
  const std::size_t width = format_.shape.width, channels = format_.shape.channels;
  const std::size_t values = values_of(format_.shape);
  parallel_for(format_.shape.height, [&](std::uint64_t y) {
    for (std::size_t pixel = y * width; pixel < (y + 1) * width; ++pixel) {
      for (std::size_t channel = 0; channel < channels; ++channel) {
        light_[pixel * values + channel] =
            static_cast<float>(codes_.light_of(raster[pixel * channels + channel]));
      }
    }
  });
}

template <typename Light, typename Code>
void LightWarp::write_row(const Warp& warp, std::uint32_t row, Code* warped) const {
  const auto [width, height, channels] = format_.shape;
  const std::uint32_t y = area_.y + row;
  PixelSpan seen = seen_span(warp, format_.shape, y);
  seen.first = std::max(seen.first, area_.x);
  seen.end = std::min(seen.end, area_.x + area_.width);
  for (std::uint32_t x = seen.first; x < seen.end; ++x) {
    const Place place = warp.at(x, y);
    const double left = std::floor(place.x), top = std::floor(place.y);
    const auto x_taps = cubic_taps(place.x - left), y_taps = cubic_taps(place.y - top);
    const auto columns = tap_pixels(left, width), rows = tap_pixels(top, height);
    Code* const to = warped + (std::size_t{row} * area_.width + (x - area_.x)) * channels;
    constexpr std::size_t kValues = sizeof(Light) / sizeof(float);
    Light sum{}, least = light_at<Light>(&light_[(rows[0] * width + columns[0]) * kValues]), most = least;
    for (std::size_t j = 0; j < kTaps; ++j) {
      const float* const from = light_.data() + rows[j] * width * kValues;
      Light along{};
      for (std::size_t i = 0; i < kTaps; ++i) {
        const auto light = light_at<Light>(from + columns[i] * kValues);
        least = least < light ? least : light;
        most = most > light ? most : light;
        along += x_taps[i] * light;
      }
      sum += y_taps[j] * along;
    }
    sum = sum < least ? least : sum;
    sum = sum > most ? most : sum;
    std::array<float, kValues> lights;
    std::memcpy(lights.data(), &sum, sizeof sum);
    for (std::uint32_t channel = 0; channel < channels; ++channel) {
      to[channel] = static_cast<Code>(codes_.code_of(double{lights[channel]}));
    }
  }
}

void LightWarp::take(std::span<const std::byte> raster, const Warp& warp, std::span<std::byte> warped) {
  const auto move = [&]<typename Code>(const Code* from, Code* to) {
    read_light(from);
    parallel_for((area_.height - 1) / kRowsAtOnce + 1, [&](std::uint64_t strip) {
      const auto first = static_cast<std::uint32_t>(strip) * kRowsAtOnce;
      for (std::uint32_t row = first; row < std::min(first + kRowsAtOnce, area_.height); ++row) {
        format_.shape.channels == 1 ? write_row<Grey>(warp, row, to) : write_row<Colour>(warp, row, to);
      }
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
