// Moments of a subject that a picture can show side by side.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/subject.hpp"

namespace nutik {

enum class MomentSpacing { time, distance };

// Up to `count` of the track's places, evenly in time or along its way, `gap_pixels` apart or more; where that finds fewer,
// others too, each as far from those as can be. No small pieces of the subject, nor its shadow alone, nor places at
// a border that leaves less than half of it; whole ones as far as there are any. In time order.
[[nodiscard]] std::vector<SubjectPlace> choose_moments(const SubjectTrack& track, std::uint32_t count,
                                                       MomentSpacing spacing, std::uint32_t gap_pixels);

}  // namespace nutik
