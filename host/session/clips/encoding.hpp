// Turns a clip into a capture file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "session/clips/clip_source.hpp"
#include "system/interruption.hpp"
#include "system/output_file.hpp"
#include "tik/codec.hpp"

namespace nutik {

struct EncodeRequest {
  std::filesystem::path output;  // .tik; gets its name when it is complete
  tik::Codec codec = tik::kUsualCodec;
  OutputFile::Lasting lasting = OutputFile::Lasting::recoverable;
};

// A capture that was encoded, and what there is to say of it.
struct EncodedCapture {
  CaptureFormat capture;  // of the clip's samples
  Timeline timeline;
  std::uint64_t file_bytes = 0;
  std::vector<Fact> facts;            // each with its origin
  std::vector<Note> notes;            // on the clip
  std::vector<std::string> warnings;  // what is doubtful about the capture, whole sentences
  std::optional<Shared<CameraPath>> camera = std::nullopt;  // of pictures that were aligned
  std::optional<ClipSound> sound = std::nullopt;
};

// Reads the whole clip; `progress` counts samples. Throws InputError if the clip has no sample or unusable times,
// OutputError if the file cannot be written, Cancelled, what ClipSource::check() throws.
[[nodiscard]] EncodedCapture encode(ClipSource source, const EncodeRequest& request, const ClipMemory& memory,
                                    const ReportedProgress& progress = {}, std::stop_token stop = {});

// Opens the clip first: throws what open_clip_source() and memory_for_encoding() do, too; UsageError if the
// output is the clip, or no name of a .tik. `open` as open_clip_source() has it.
[[nodiscard]] EncodedCapture encode(const SourceRequest& source, const EncodeRequest& request,
                                    const MemoryBudget& memory, const ReportedProgress& progress = {},
                                    std::stop_token stop = {}, const OpenClip& open = {});

}  // namespace nutik
