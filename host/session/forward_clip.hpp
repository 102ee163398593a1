// A clip that is exposed while it is read, no further than one picture needs.
#pragma once

#include <functional>

#include "imev/capture_source.hpp"
#include "session/clip_source.hpp"
#include "session/exposed_picture.hpp"
#include "session/exposure_request.hpp"

namespace nutik {

// Exposes what was planned of a stream of blocks, which takes so many bytes of memory.
using ExposeStream =
    std::function<ExposedPicture(CaptureSource& stream, const FunctionSet& functions, const Mask& mask,
                                 const PlanOptions& options, std::uint64_t stream_bytes)>;

// How many samples a clip has is known for sure only when it has been read to its end, which an exposure of its
// beginning never does. So its files' word is taken, and where decoding proves it wrong, the clip is read once more
// with the right number. `type` is the picture's, `besides` is held at the same time. Throws InputError where fewer can
// be decoded each time, MemoryTooLittle, BlocksTooLong.
[[nodiscard]] ExposedPicture expose_forward(ClipSource source, const MemoryBudget& memory,
                                            const ExposureRequest& request, ValueType type,
                                            const MemoryNeeds& besides, const ExposeStream& expose);

}  // namespace nutik
