// A capture of some pictures of a capture, or of fewer pixels, as for previews that are zoomed out (what a scale leaves
// over at the right and at the bottom is dropped). A part counts the pictures that were filmed, and has the samples
// that were made between those that it takes. It has devices of its own, with a quarter of the memory besides, so
// that exposures of the whole capture lose nothing that is kept for them. `whole` was read whole, and is needed until
// this returns. Throws as Session's constructor does.
#pragma once

#include <memory>
#include <stop_token>

#include "media/clip.hpp"
#include "session/session.hpp"

namespace nutik {

[[nodiscard]] std::shared_ptr<Session> session_of_part(Session& whole, const ClipOptions& part,
                                                       const ReportedProgress& progress = {},
                                                       std::stop_token stop = {});

}  // namespace nutik
