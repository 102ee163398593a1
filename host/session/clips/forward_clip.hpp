// Exposes a clip while it is read, and reads no further than the picture needs.
#pragma once

#include <functional>

#include "imev/capture_source.hpp"
#include "session/clips/clip_source.hpp"
#include "session/exposed_picture.hpp"
#include "session/requests/exposure_request.hpp"

namespace nutik {

// Exposes a stream of blocks; the stream itself takes `stream_bytes` of memory.
using ExposeStream =
    std::function<ExposedPicture(CaptureSource& stream, const FunctionSet& functions, const Mask& mask,
                                 const PlanOptions& options, std::uint64_t stream_bytes)>;

// A clip's number of samples is certain only at its end, which an exposure of its beginning never reaches. So the number
// that its files announce is used; if decoding proves it wrong, the clip is read once more with the right one. `type` is
// the picture's, `besides` is held at the same time. Throws InputError if fewer samples can be decoded each time,
// MemoryTooLittle, UsageError where blocks of the stated length do not fit.
[[nodiscard]] ExposedPicture expose_forward(ClipSource source, const MemoryBudget& memory,
                                            const ExposureRequest& request, ValueType type,
                                            const MemoryNeeds& besides, const ExposeStream& expose);

}  // namespace nutik
