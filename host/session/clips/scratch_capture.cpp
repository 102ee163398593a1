#include "session/clips/scratch_capture.hpp"

#include <filesystem>
#include <utility>

#include "imev/expected_values.hpp"
#include "system/temporary_folder.hpp"

namespace nutik {
namespace {

// Whether there is plenty of room for a capture that is not packed: it is read many times, and kept for no longer than
// that. A packed one is quick to unpack.
bool has_room_for(const ClipSource& clip) {
  constexpr double kMaxOfRoom = 0.25;
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(temporary_folder(), error);
  const std::uint64_t samples = clip.announced_samples();
  return !error && samples > 0 &&
         static_cast<double>(samples) * static_cast<double>(held_format(clip.capture).sample_bytes()) <=
             kMaxOfRoom * static_cast<double>(space.available);
}

}  // namespace

ScratchCapture encode_to_scratch(const SourceRequest& source, const OpenClip& open,
                                 const MemoryBudget& memory, const NeedsOfFormat& rendering,
                                 const ReportedProgress& progress, std::stop_token stop) {
  const TwofoldProgress twofold(source, progress);
  ClipSource clip = open ? open_clip_source(source, open, memory, twofold.finding, stop)
                         : open_clip_source(source, memory, twofold.finding, stop);
  const ClipToRead to_read = clip.clip_to_read();
  ClipMemory shares = memory_for_encoding(memory, to_read, rendering(clip.capture));
  // Blocks as those of a clip that is read forward: a picture has the same bits either way.
  if (!to_read.block_samples && !to_read.tells_changes) shares.blocks = BlockLimits(shares.stream_samples);
  const NamelessFile file;
  const EncodeRequest request{
      file.path(), {has_room_for(clip) ? tik::CodecId::none : tik::CodecId::lz4, 0}, OutputFile::Lasting::no};
  EncodedCapture encoded = encode(std::move(clip), request, shares, twofold.reading, std::move(stop));
  return {std::make_unique<tik::Reader>(request.output), std::move(encoded)};
}

}  // namespace nutik
