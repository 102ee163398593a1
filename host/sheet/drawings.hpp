// Pictures of pictures: small ones, masks over them, and when and where a capture changes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "capture/picture.hpp"
#include "capture/timeline.hpp"
#include "exposure/mask.hpp"
#include "imev/activity.hpp"

namespace nutik::sheet {

// A picture of codes at another size, as 8-bit sRGB: each pixel has the mean light of the area that it covers,
// so that fine bright patterns keep their brightness. Channels stay as they are. Codes of which nobody said what they
// stand for are taken to be sRGB.
[[nodiscard]] Picture thumbnail(const Picture& picture, std::uint32_t width, std::uint32_t height);

// The same as large as fits into a square of `side` pixels, and no larger than the picture is shown: with
// CaptureFormat::shown_shape(), in square pixels.
[[nodiscard]] Picture fitted_thumbnail(const Picture& picture, const Shape& shown, std::uint32_t side);

// Every tag but 0 as a colour over the greys of the picture, with its number where its region is widest, and
// below it a legend: colour, tag, pixels. Tag 0 shows the picture as it is. The picture is one of codes, of the
// mask's size; a small one is enlarged by a whole number. Pixels that are not square are drawn as long as they are
// shown, so that the overlay's are.
[[nodiscard]] Picture mask_overlay(const Mask& mask, const Picture& picture);

// A grey picture of 8 bits of a capture of this shape: light is the share of the most changes that any pixel has, shown
// through the sRGB curve so that rare changes can be seen. `changes` has a number for each pixel, row-major.
[[nodiscard]] Picture activity_map(const Shape& shape, std::span<const std::uint64_t> changes);

// The share of pixels that change at each sample against time, with the busiest and the quietest stretch marked.
// `changed_pixels` has a number for each sample of the timeline, `pixel_count` what all of them would be. Where
// there are more samples than can be told apart, each point shows the most of several.
[[nodiscard]] Picture activity_chart(const std::string& heading, const Timeline& timeline,
                                     std::span<const std::uint64_t> changed_pixels, std::uint64_t pixel_count,
                                     const std::optional<ActivityMoments>& moments);

}  // namespace nutik::sheet
