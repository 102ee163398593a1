// The limit that rendering is measured against: how fast the machine reads memory.
#pragma once

#include <cstddef>
#include <span>

namespace nutik::bench {

// Bytes a second that all cores together read from `memory` (which should be far larger than the
// caches): the best of several runs.
[[nodiscard]] double read_bandwidth(std::span<const std::byte> memory);

}  // namespace nutik::bench
