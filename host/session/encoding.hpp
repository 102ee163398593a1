// Turns a clip into a capture file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "session/clip_source.hpp"
#include "session/reported_progress.hpp"
#include "system/output_file.hpp"
#include "tik/codec.hpp"

namespace nutik {

struct EncodeRequest {
  std::filesystem::path output;  // .tik; appears under its name when it is whole
  tik::Codec codec{tik::CodecId::zstd, 0};
  OutputFile::Lasting lasting = OutputFile::Lasting::yes;
  friend bool operator==(const EncodeRequest&, const EncodeRequest&) = default;
};

// What an encoding came to.
struct Encoded {
  CaptureFormat capture;  // of the clip's samples
  Timeline timeline;
  std::uint64_t file_bytes = 0;
  std::vector<Fact> facts;            // what it was taken for
  std::vector<Note> notes;            // on the clip
  std::vector<std::string> warnings;  // what is doubtful about the capture, whole sentences
  std::optional<Shared<CameraPath>> camera = std::nullopt;  // of pictures that were aligned
};

// Reads all of the clip; `progress` counts samples. Throws InputError where there is no sample or where the clip's
// times cannot be used, OutputError where the file cannot be written, Cancelled.
[[nodiscard]] Encoded encode(ClipSource source, const EncodeRequest& request, const ClipMemory& memory,
                             const ReportedProgress& progress = {}, std::stop_token stop = {});

// The same of what open_clip_source() opens; throws MemoryTooLittle, BlocksTooLong besides.
[[nodiscard]] Encoded encode(const SourceRequest& source, const EncodeRequest& request,
                             const MemoryBudget& memory, const ReportedProgress& progress = {},
                             std::stop_token stop = {});

}  // namespace nutik
