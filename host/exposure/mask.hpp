// Masks: which gain function each pixel is exposed with, and which pixels several functions share.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/picture.hpp"
#include "exposure/mixed_pixels.hpp"

namespace nutik {

inline constexpr std::uint32_t kMaskValues = 256;

// One tag (mask value) per pixel, row by row: of a mixed pixel the one with the largest share, of equals the lowest.
struct Mask {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> tags;
  MixedPixels mixed = {};  // none of a hard mask

  // A mask of one tag.
  static Mask uniform(std::uint32_t width, std::uint32_t height, std::uint8_t tag) {
    return {width, height, std::vector<std::uint8_t>(std::size_t{width} * height, tag), {}};
  }

  // The codes of an 8-bit picture with one channel, taken literally.
  static Mask from_picture(const Picture& picture) {
    const auto codes = picture.values<std::uint8_t>();
    return {picture.shape.width, picture.shape.height, {codes.begin(), codes.end()}, {}};
  }

  // The picture of its tags.
  [[nodiscard]] Picture to_picture() const {
    Picture picture({width, height, 1}, ValueType::code8, 255);
    std::copy(tags.begin(), tags.end(), picture.values<std::uint8_t>().begin());
    return picture;
  }

  [[nodiscard]] bool is_soft() const { return !mixed.empty(); }

  // How many pixels have each tag, or a share of it. Throws InputError where a mixed pixel or its tag is no mask's.
  [[nodiscard]] std::array<std::uint64_t, kMaskValues> pixels_per_tag() const {
    std::array<std::uint64_t, kMaskValues> counts{};
    // Neighbours have the same tag, mostly: a run is counted at once.
    for (auto run = tags.begin(); run != tags.end();) {
      const auto end = std::find_if(run, tags.end(), [tag = *run](std::uint8_t other) { return other != tag; });
      counts[*run] += static_cast<std::uint64_t>(end - run);
      run = end;
    }
    for (std::size_t i = 0; i < mixed.pixels().size(); ++i) {
      const std::uint64_t pixel = mixed.pixels()[i];
      if (pixel >= tags.size() || mixed.shares(i).back().of >= kMaskValues) {
        throw InputError(format("pixel {} shares value {}, and the mask has {} pixels and values up to {}", pixel,
                                mixed.shares(i).back().of, tags.size(), kMaskValues - 1));
      }
      const std::uint8_t counted = tags[pixel];
      for (const Share& share : mixed.shares(i)) counts[share.of] += share.of != counted;
    }
    return counts;
  }

  friend bool operator==(const Mask&, const Mask&) = default;
};

}  // namespace nutik
