// What is made of times that are not those of any rate, told in notes.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "capture/error.hpp"
#include "capture/timeline.hpp"

namespace nutik {

// What a stated rate does to times of none: which steps from one picture to the next become even, and how long they
// were; nothing where there are fewer than two steps, for these are even. Times are in order.
[[nodiscard]] std::optional<Note> evened_note(const std::vector<std::int64_t>& starts_ns);

// How many steps are longer than one and a half usual ones, as where pictures were dropped, and that the picture before
// such a step counts as exposed for the shutter's share of the whole step. For a timeline that was made from starts and
// an angle; one with a rate has no note.
[[nodiscard]] std::optional<Note> gap_note(const Timeline& timeline);

}  // namespace nutik
