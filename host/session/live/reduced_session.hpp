// A capture with fewer pixels, for previews that are zoomed out.
#pragma once

#include <cstdint>
#include <memory>
#include <stop_token>

#include "session/session.hpp"

namespace nutik {

// One pixel for each square of `divisor`; what is left over at the right and at the bottom is left out. On devices of
// its own, with a quarter of the memory besides: exposures of the whole capture lose nothing of what is kept for them.
// `whole` was read whole, and is needed until this returns. Throws as Session's constructor does.
[[nodiscard]] std::shared_ptr<Session> reduced_session(Session& whole, std::uint32_t divisor,
                                                       const ReportedProgress& progress = {},
                                                       std::stop_token stop = {});

}  // namespace nutik
