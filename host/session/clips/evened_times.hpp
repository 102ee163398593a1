// What is made of times that are not those of any rate: what a stated rate does to them, and what is taken for exposed
// where pictures are missing.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "capture/error.hpp"
#include "capture/timeline.hpp"

namespace nutik {

// Which steps from one picture to the next become even, and how long they were; nothing where there are fewer than two
// steps, for these are even. Times are in order.
[[nodiscard]] std::optional<Note> evened_note(const std::vector<std::int64_t>& starts_ns);

// Where steps are longer than the usual one by half of it and more, as where pictures were dropped: how many, and that
// a picture before one counts as exposed for its share of all of it. Of a timeline that was made from starts and an
// angle; nothing of one with a rate.
[[nodiscard]] std::optional<Note> gap_note(const Timeline& timeline);

}  // namespace nutik
