// Which places of a subject show enough of it to be one of a picture's moments.
#pragma once

#include <vector>

#include "scene/subject.hpp"

namespace nutik {

using Places = std::vector<const SubjectPlace*>;  // in time order

// Those that are no mere piece of the subject, of which the rest looks like what is behind it, nor only its shadow, nor
// at a border that leaves less than half of it: a head alone at the bottom.
[[nodiscard]] Places telling_places(const std::vector<SubjectPlace>& places);

// Those of them that no border cuts off.
[[nodiscard]] Places whole_places(const Places& places);

[[nodiscard]] double distance(const Point& a, const Point& b);

// How far a whole one of them, or any if none is whole, lies from another at most that shares no cell with it, in pixels;
// 0 if all share some.
[[nodiscard]] double furthest_apart(const Places& places);

}  // namespace nutik
