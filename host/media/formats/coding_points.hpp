// The numbers of ITU-T H.273, by which containers, FFmpeg and PNG's cICP name transfer functions and primaries.
#pragma once

#include <cstdint>
#include <optional>

#include "capture/primaries.hpp"
#include "capture/transfer.hpp"

namespace nutik {

// None where the standard has none for a function.
[[nodiscard]] std::optional<std::uint8_t> coding_point(const Transfer& transfer);
[[nodiscard]] std::uint8_t coding_point(Primaries primaries);
inline constexpr std::uint8_t kUnnamedPrimaries = 2;

// What is known here by a number, or is the same to an eye: NTSC's and PAL's primaries differ from BT.709's by less
// than it notices. None for others, and for what is not said.
[[nodiscard]] std::optional<Transfer> transfer_of_coding_point(unsigned number);
[[nodiscard]] std::optional<Primaries> primaries_of_coding_point(unsigned number);

}  // namespace nutik
