// Moments of a subject that a picture can show side by side, and the places that show enough of it to be one.
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

using Places = std::vector<const SubjectPlace*>;  // in time order

// Those that are no mere piece of the subject, of which the rest looks like what is behind it, nor only its shadow, nor
// at a border that leaves less than half of it: a head alone at the bottom.
[[nodiscard]] Places telling_places(const std::vector<SubjectPlace>& places);

// Those of them that no border cuts off.
[[nodiscard]] Places whole_places(const Places& places);

// The last that shows the subject best: of those that tell, whole, and at least half as large as most such. The last of
// all if none is. `places` has some.
[[nodiscard]] const SubjectPlace& last_large_place(const std::vector<SubjectPlace>& places);

[[nodiscard]] double distance(const Point& a, const Point& b);

// How far a whole one of them, or any if none is whole, lies from another at most that shares no cell with it, in pixels;
// 0 if all share some.
[[nodiscard]] double furthest_apart(const Places& places);

// Whether both are mostly the same cells when both are seen, and that often enough: one thing that was followed twice.
[[nodiscard]] bool are_of_one_thing(const std::vector<SubjectPlace>& a, const std::vector<SubjectPlace>& b);

}  // namespace nutik
