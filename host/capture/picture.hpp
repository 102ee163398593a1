// Rasters: the shape of a capture's pictures, how its codes are stored, and a picture that was made.
//
// All rasters are row-major from the top left, channels interleaved (grey, or red green blue), native
// byte order, no padding.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "capture/format.hpp"
#include "capture/noise_model.hpp"
#include "capture/primaries.hpp"
#include "capture/rational.hpp"
#include "capture/transfer.hpp"

namespace nutik {

struct Shape {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t channels = 0;  // 1 or 3

  [[nodiscard]] std::uint64_t pixel_count() const { return std::uint64_t{width} * height; }
  [[nodiscard]] std::uint64_t value_count() const { return pixel_count() * channels; }
  friend bool operator==(const Shape&, const Shape&) = default;
};

// Some pixels of a picture, counted from its top left.
struct Rectangle {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 0;

  [[nodiscard]] static Rectangle whole(const Shape& shape) { return {0, 0, shape.width, shape.height}; }
  // Whether it has pixels, and all of them are the picture's.
  [[nodiscard]] bool lies_in(const Shape& shape) const {
    return width > 0 && height > 0 && std::uint64_t{x} + width <= shape.width &&
           std::uint64_t{y} + height <= shape.height;
  }
  friend bool operator==(const Rectangle&, const Rectangle&) = default;
};

// `grey`, or `red`, `green`, `blue` of three.
[[nodiscard]] constexpr const char* channel_name(std::size_t channels, std::size_t channel) {
  constexpr const char* kNames[] = {"red", "green", "blue"};
  return channels == 1 ? "grey" : kNames[channel];
}

// What red, green and blue add to the brightness of a colour (ITU-R BT.709).
inline constexpr double kLuma[3] = {0.2126, 0.7152, 0.0722};

// The size in square pixels of so many that are `aspect` times as wide as high: no side smaller than it is.
[[nodiscard]] inline Shape in_square_pixels(Shape shape, const Rational& aspect) {
  const auto longer = [](std::uint32_t side, std::int64_t by, std::int64_t than) {
    return static_cast<std::uint32_t>(round_half_up(static_cast<int128>(side) * by, than));
  };
  const auto [wide, high] = aspect;
  if (wide > high) shape.width = longer(shape.width, wide, high);
  if (high > wide) shape.height = longer(shape.height, high, wide);
  return shape;
}

// What the codes of a capture are.
struct CaptureFormat {
  Shape shape = {};
  std::uint32_t code_bytes = 1;    // 1 or 2
  std::uint32_t white_code = 255;  // the code that stands for light 1; no code is larger
  Transfer transfer = Transfer::srgb();
  NoiseModel noise = {};
  Primaries primaries = Primaries::bt709;  // of colour
  Rational pixel_aspect{1, 1};             // how much wider than high a pixel is to be shown

  [[nodiscard]] std::uint64_t sample_bytes() const { return shape.value_count() * code_bytes; }
  [[nodiscard]] Shape shown_shape() const { return in_square_pixels(shape, pixel_aspect); }
  friend bool operator==(const CaptureFormat&, const CaptureFormat&) = default;
};

// What no capture has, behind `a clip `: `has 1 or 3 channels, not 2`; empty of a format that is right.
[[nodiscard]] inline std::string mistake_in(const CaptureFormat& of) {
  const std::uint32_t last = of.code_bytes == 1 ? 255 : 65'535;
  if (of.shape.width == 0 || of.shape.height == 0)
    return format("has pixels, not {} x {} of them", of.shape.width, of.shape.height);
  if (of.shape.channels != 1 && of.shape.channels != 3)
    return format("has 1 or 3 channels, not {}", of.shape.channels);
  if (of.code_bytes != 1 && of.code_bytes != 2) return format("has codes of 1 or 2 bytes, not of {}", of.code_bytes);
  if (of.white_code == 0 || of.white_code > last)
    return format("whose codes end at {} has a white code of 1 … {}, not {}", last, last, of.white_code);
  if (of.pixel_aspect.numerator <= 0 || of.pixel_aspect.denominator <= 0)
    return format("has pixels of some width and height, not {}", of.pixel_aspect.text());
  return {};
}

enum class ValueType { code8, code16, light32, light64 };

[[nodiscard]] constexpr std::size_t value_bytes(ValueType type) {
  switch (type) {
    case ValueType::code8: return 1;
    case ValueType::code16: return 2;
    case ValueType::light32: return 4;
    case ValueType::light64: return 8;
  }
  return 0;
}

// What a capture's codes are as values of a picture.
[[nodiscard]] constexpr ValueType code_type(const CaptureFormat& capture) {
  return capture.code_bytes == 1 ? ValueType::code8 : ValueType::code16;
}

[[nodiscard]] constexpr bool holds_codes(ValueType type) {
  return type == ValueType::code8 || type == ValueType::code16;
}

// A finished picture: codes 0 … white_code, or light as floating point (neither clipped nor encoded).
struct Picture {
  Shape shape;
  ValueType type = ValueType::code8;
  std::uint32_t white_code = 255;  // meaningful for codes
  std::vector<std::byte> bytes;

  // What the values mean to whoever shows them.
  std::optional<Transfer> transfer;  // of codes; none: they stand for no light, or nobody said
  Primaries primaries = Primaries::bt709;
  Rational pixel_aspect{1, 1};
  std::optional<std::int64_t> exposed_ns = std::nullopt;  // how long its light was gathered, if that is one time

  Picture() = default;
  Picture(Shape picture_shape, ValueType value_type, std::uint32_t white)
      : shape(picture_shape),
        type(value_type),
        white_code(white),
        bytes(picture_shape.value_count() * value_bytes(value_type)) {}

  // The values as T, whose size must be that of the picture's type.
  template <typename T>
  [[nodiscard]] std::span<T> values() {
    check_size(sizeof(T));
    return {reinterpret_cast<T*>(bytes.data()), shape.value_count()};
  }
  template <typename T>
  [[nodiscard]] std::span<const T> values() const {
    check_size(sizeof(T));
    return {reinterpret_cast<const T*>(bytes.data()), shape.value_count()};
  }

  friend bool operator==(const Picture&, const Picture&) = default;

 private:
  void check_size(std::size_t size) const {
    if (size != value_bytes(type)) throw std::logic_error("a picture was read as another value type");
  }
};

// One of several grey pictures of light, all of one size, that a file holds.
struct PictureLayer {
  std::string name;
  std::string text;  // what its values are
  Picture values;
};

// Calls visit() with codes of 1 or 2 bytes as what they are.
template <typename Byte, typename Visit>
decltype(auto) with_codes(std::uint32_t code_bytes, Byte* codes, Visit visit) {
  const auto as = [&]<typename Code>(Code) {
    return reinterpret_cast<std::conditional_t<std::is_const_v<Byte>, const Code, Code>*>(codes);
  };
  return code_bytes == 1 ? visit(as(std::uint8_t{})) : visit(as(std::uint16_t{}));
}

// The largest of a raster's codes; 0 where it has none.
[[nodiscard]] inline std::uint32_t largest_code(std::span<const std::byte> raster, std::uint32_t code_bytes) {
  return with_codes(code_bytes, raster.data(), [&](const auto* codes) {
    std::uint32_t largest = 0;
    for (std::size_t i = 0; i < raster.size() / code_bytes; ++i) largest = std::max<std::uint32_t>(largest, codes[i]);
    return largest;
  });
}

}  // namespace nutik
