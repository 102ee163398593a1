// Moments of a subject that a picture can show side by side, and the places that show enough of it to be one.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "scene/subject.hpp"

namespace nutik {

enum class MomentSpacing { time, distance };

// Chooses up to `count` of the track's places, evenly in time or along its way, at least `gap_pixels` apart; if these
// are fewer, then others, each as far from the chosen ones as possible. Only telling_places(), whole ones if there are
// any; as far from `taken` places of other subjects. Where that leaves one, whole places of which an eighth at most is
// nearer: what hangs is always near itself there. In time order.
[[nodiscard]] std::vector<SubjectPlace> choose_moments(const SubjectTrack& track, std::uint32_t count,
                                                       MomentSpacing spacing, std::uint32_t gap_pixels,
                                                       const std::vector<SubjectPlace>& taken = {});

using Places = std::vector<const SubjectPlace*>;  // in time order

// The median of a measure over all cells that places cover, but for shadows; 0 without any. So scraps that are followed
// on when the thing has left the picture do not stand for it, however often they are seen.
[[nodiscard]] double usual(const Places& places, const std::function<double(const SubjectPlace&)>& measure);

// The places that show the subject: more than a piece of it whose rest looks like the background, more than its shadow,
// and at a border more than half of it, not a head alone at the bottom.
[[nodiscard]] Places telling_places(const std::vector<SubjectPlace>& places);

// Those of them that no border cuts off.
[[nodiscard]] Places whole_places(const Places& places);

// The last of the telling places that are whole and at least half as large as most of these; without any the last
// place. `places` has some.
[[nodiscard]] const SubjectPlace& last_large_place(const std::vector<SubjectPlace>& places);

[[nodiscard]] double distance(const Point& a, const Point& b);

// The largest distance, in pixels, between two places that share no cell: whole ones, or any if none is whole; 0 if all
// share some.
[[nodiscard]] double furthest_apart(const Places& places);

// Whether both mostly share cells when both are seen, and often enough: one thing that was followed twice.
[[nodiscard]] bool are_of_one_thing(const std::vector<SubjectPlace>& a, const std::vector<SubjectPlace>& b);

}  // namespace nutik
