// The two ways in which a session reads a clip: whole, as a temporary capture that can be read anywhere and repeatedly,
// or forward while a picture is exposed, no further than that needs.
#pragma once

#include <functional>
#include <memory>
#include <stop_token>

#include "imev/capture_source.hpp"
#include "session/clips/clip_source.hpp"
#include "session/clips/encoding.hpp"
#include "session/exposed_picture.hpp"
#include "session/requests/exposure_request.hpp"
#include "tik/reader.hpp"

namespace nutik {

struct ScratchCapture {
  std::unique_ptr<tik::Reader> reader;
  EncodedCapture encoded;
};

// Encodes into a temporary file without a name, in TMPDIR, else /tmp: it takes no space once the reader is gone,
// however the process ends. Throws as encode() does, OutputError where there is no space.
// `rendering` tells what will be held while the capture is used, beside a block of it.
// `open` makes the clip in place of the one at the source's path; it may be empty.
[[nodiscard]] ScratchCapture encode_to_scratch(const SourceRequest& source, const OpenClip& open,
                                               const MemoryBudget& memory, const NeedsOfFormat& rendering,
                                               const ReportedProgress& progress = {},
                                               std::stop_token stop = {});

// Exposes a stream of blocks; the stream itself takes `stream_bytes` of memory.
using ExposeStream =
    std::function<ExposedPicture(CaptureSource& stream, const FunctionSet& functions, const Mask& mask,
                                 const PlanOptions& options, std::uint64_t stream_bytes)>;

// A clip's number of samples is certain only at its end, which an exposure of its beginning never reaches. So the
// number that its files announce is used; if decoding proves it wrong, the clip is read once more with the right one.
// `type` is the picture's, `besides` is held at the same time; `notes` gets what only its pictures
// told. Throws InputError if fewer samples can be decoded each time, MemoryTooLittle, UsageError where blocks of the
// stated length do not fit.
[[nodiscard]] ExposedPicture expose_forward(ClipSource source, const MemoryBudget& memory,
                                            const ExposureRequest& request, ValueType type,
                                            const MemoryNeeds& besides, const ExposeStream& expose,
                                            std::vector<Note>& notes);

}  // namespace nutik
