// Clips of few pictures a second as if there were more: between two pictures as many are made as the motion there
// needs, along it (align/in_between.hpp).
//
//   in:      a clip, which is read twice: once for how much moves, once for its pictures
//   out:     a clip of its own pictures, bit for bit, and those made between them; which are which
//   always:  none is made where nothing can be followed, nor across a cut. What is made follows from the two pictures
//            round it, whatever the number of threads
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "align/alignment.hpp"
#include "capture/made_samples.hpp"

namespace nutik {

struct BetweenRequest {
  std::optional<std::uint32_t> each = {};  // so many between any two; none: as many as the motion there needs
  // From this picture on, of those that are taken of the clip, to this one, and nowhere else.
  std::uint64_t first = 0, last = UINT64_MAX;
  std::optional<Shared<MadeSamples>> made = {};  // known already
  [[nodiscard]] std::string text() const;  // as parse_between() reads it
  friend bool operator==(const BetweenRequest&, const BetweenRequest&) = default;
};

// `auto`, `off`, or a number from 1 to MadeSamples::kMost; `auto:10f..20f` between these pictures alone. Throws
// UsageError.
[[nodiscard]] std::optional<BetweenRequest> parse_between(std::string_view text);

// Reads all of the clip; `progress` counts its pictures. Throws MemoryTooLittle, Cancelled, InputError where it cannot
// be read or has no picture.
[[nodiscard]] MadeSamples plan_between(const ClipToAlign& clip, const BetweenRequest& request,
                                       std::uint64_t memory_bytes, const ReportedProgress& progress,
                                       const std::stop_token& stop);

// read() throws InputError where the clip has not as many pictures as were planned for.
[[nodiscard]] std::unique_ptr<Clip> open_between(const ClipToAlign& clip, const Shared<MadeSamples>& made);

}  // namespace nutik
