// Changes of a capture over time, as a graph.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "capture/picture.hpp"
#include "capture/timeline.hpp"
#include "imev/activity_moments.hpp"

namespace nutik::sheet {

// The share of pixels that change at each sample against time, with the busiest and the quietest stretch marked.
// `changed_pixels` has a number for each sample of the timeline, `pixel_count` what all of them would be. Where
// there are more samples than can be told apart, each point shows the most of several.
[[nodiscard]] Picture activity_chart(const std::string& heading, const Timeline& timeline,
                                     std::span<const std::uint64_t> changed_pixels, std::uint64_t pixel_count,
                                     const std::optional<ActivityMoments>& moments);

}  // namespace nutik::sheet
