// A clip as a temporary capture that can be read anywhere and repeatedly.
#pragma once

#include <memory>
#include <stop_token>

#include "session/clips/encoding.hpp"
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

}  // namespace nutik
