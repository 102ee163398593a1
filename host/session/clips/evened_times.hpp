// What a stated rate does to times that are not those of any rate.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "capture/error.hpp"

namespace nutik {

// Which steps from one picture to the next become even, and how long they were; nothing where there are fewer than two
// steps, for these are even. Times are in order.
[[nodiscard]] std::optional<Note> evened_note(const std::vector<std::int64_t>& starts_ns);

}  // namespace nutik
