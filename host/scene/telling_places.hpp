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
