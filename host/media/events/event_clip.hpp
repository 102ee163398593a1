// Recordings without pictures, whose pixels keep their own time.
//
//   in:      a file of Prophesee's cameras (.raw: EVT2, EVT2.1, EVT3; .dat), or ADΔER's (.adder, raw)
//   out:     a clip with a sample for every moment at which some pixel changes, and for no other
//   always:  codes of 16 bits, made here of what the file tells of light. Everything costs by changes, whatever the
//            file's ticks are: a sample is exposed until the next one
//
// The recording is held in memory: 12 bytes for each change, 64 for each sample; while it is opened, 16 more for each
// event. That is counted before it is held, and is refused where it is more than ClipOptions::decoder_bytes.
#pragma once

#include <filesystem>
#include <memory>

#include "media/clip.hpp"

namespace nutik {

// Whether a file is such a recording, also of a kind that is not read; told by how it begins.
[[nodiscard]] bool is_event_recording(const std::filesystem::path& path);

// Throws InputError if the file is damaged, holds no event, or is of a kind that is not read, with the way out;
// UsageError if what is stated cannot be said of it, MemoryTooLittle.
[[nodiscard]] std::unique_ptr<Clip> open_event_clip(const std::filesystem::path& path,
                                                    const ClipOptions& options);

}  // namespace nutik
