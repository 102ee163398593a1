// What is wrong or suspicious about a mask: its size, values without a function, and pixels that nobody
// painted on purpose.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "capture/error.hpp"
#include "capture/picture.hpp"
#include "exposure/mask.hpp"

namespace nutik {

// Throws InputError, `title` first, with both sizes and the way out where the mask does not have the capture's.
void check_size(const Mask& mask, const CaptureFormat& capture, const std::string& title = {});
// What ends such a message where the program itself makes pictures of that size of the capture: in square pixels, or of
// a part; else empty.
[[nodiscard]] Advice size_advice(std::uint32_t width, std::uint32_t height, const CaptureFormat& capture);

// The values that pixels have and no function, with their numbers of pixels and the way out; else empty.
[[nodiscard]] std::string unmapped_mistake(const std::array<std::uint64_t, kMaskValues>& pixels_per_tag,
                                           const std::array<bool, kMaskValues>& is_mapped);

// A patch of one value, connected at edges or corners, that is too small to have been meant: at most 16 pixels
// and a thousandth of the mask.
struct MaskSpeck {
  std::uint8_t tag = 0;
  std::uint32_t x = 0;  // of its first pixel, row by row
  std::uint32_t y = 0;
  std::uint64_t pixel_count = 0;
};

// Values at the border between two others that smoothing or JPEG made, not a person.
struct BlendedValue {
  std::uint8_t value = 0;
  std::uint64_t pixel_count = 0;
  std::uint32_t x = 0;  // of its first pixel, row by row
  std::uint32_t y = 0;
};

struct MaskFlaws {
  std::vector<MaskSpeck> specks;      // by tag, then row by row; none of a blended value
  std::vector<BlendedValue> blended;  // by value
};

// A value is blended where it has at most a hundredth of the mask's pixels and at least half of them
//
//   lie between values: a neighbour (of eight) has a lower and another a higher one; or
//   touch a value at most 8 away, where one at most 8 away has a hundred times as many pixels, as what JPEG
//   leaves round an edge. Only of values that are not mapped: a person who wrote a function for a value
//   means it.
//
// The time this takes is proportional to the number of pixels.
[[nodiscard]] MaskFlaws find_flaws(const Mask& mask, const std::array<bool, kMaskValues>& is_mapped);

}  // namespace nutik
