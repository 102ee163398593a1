// Changes of a capture over time, as a graph.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "capture/picture.hpp"
#include "capture/timeline.hpp"
#include "imev/activity.hpp"

namespace nutik::sheet {

// Where a capture changes, as a picture.

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
