// Masks: which gain function each pixel is exposed with.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "capture/picture.hpp"

namespace nutik {

inline constexpr std::uint32_t kMaskValues = 256;

// One tag (mask value) per pixel, row by row.
struct Mask {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> tags;

  // A mask of one tag.
  static Mask uniform(std::uint32_t width, std::uint32_t height, std::uint8_t tag) {
    return {width, height, std::vector<std::uint8_t>(std::size_t{width} * height, tag)};
  }

  // The codes of an 8-bit picture with one channel, taken literally.
  static Mask from_picture(const Picture& picture) {
    const auto codes = picture.values<std::uint8_t>();
    return {picture.shape.width, picture.shape.height, {codes.begin(), codes.end()}};
  }

  // The same picture again.
  [[nodiscard]] Picture to_picture() const {
    Picture picture({width, height, 1}, ValueType::code8, 255);
    std::copy(tags.begin(), tags.end(), picture.values<std::uint8_t>().begin());
    return picture;
  }

  // How many pixels have each tag.
  [[nodiscard]] std::array<std::uint64_t, kMaskValues> pixels_per_tag() const {
    std::array<std::uint64_t, kMaskValues> counts{};
    for (const std::uint8_t tag : tags) ++counts[tag];
    return counts;
  }

  friend bool operator==(const Mask&, const Mask&) = default;
};

}  // namespace nutik
