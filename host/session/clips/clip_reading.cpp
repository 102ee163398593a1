#include "session/clips/clip_reading.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "imev/expected_values.hpp"
#include "media/read_ahead.hpp"
#include "render/delayed_pairs.hpp"
#include "session/clips/clip_memory.hpp"
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

ExposedPicture expose_once(ClipSource& source, std::uint64_t sample_count, const MemoryBudget& memory,
                           const ExposureRequest& request, ValueType type, const MemoryNeeds& besides,
                           const ExposeStream& expose, std::vector<Note>& notes) {
  const Timeline timeline = source.timeline(sample_count);
  const FunctionSet functions = functions_of(request, timeline);
  const Mask mask = mask_of(request, source.capture.shape);
  PlanOptions options = plan_options_of(request, source.capture.shape);
  options.transfer.reset();  // it went into the capture's format
  // With delays there is a function for each pair of both that occurs.
  const std::size_t function_count =
      options.delays ? DelayedPairs(mask, *options.delays).count() : functions.size();
  MemoryNeeds rendering = rendering_needs(source.capture, type, function_count,
                                          source.request.block_samples.value_or(kDefaultBlockSamples));
  rendering.add(besides);
  const ClipMemory shares = memory_for_streaming(memory, source.clip_to_read(), rendering);
  const SampleRange needed = needed_samples(timeline, functions, mask, options);
  const std::uint64_t last =
      streamed_samples(source.capture, needed, shares.stream_samples, timeline.sample_count()).last;
  // Where the exposure reaches the timeline's end, the clip is read on: further samples would prove the timeline wrong.
  const bool is_end = last == timeline.sample_count();
  ReadAhead samples(*source.clip, shares.read_ahead_bytes, is_end ? ReadAhead::kAll : last);
  StreamingCapture stream(source.capture, timeline, needed, shares.stream_samples, source.request.tiles,
                          [&](std::uint64_t most) { return samples.next(most); });
  ExposedPicture exposed = expose(stream, functions, mask, options, shares.bytes);
  if (auto reason = source.clip->ended_early()) exposed.warnings.push_back(std::move(*reason));
  std::ranges::move(source.clip->remarks(), std::back_inserter(notes));
  return exposed;
}

}  // namespace

ScratchCapture encode_to_scratch(const SourceRequest& source, const OpenClip& open,
                                 const MemoryBudget& memory, const NeedsOfFormat& rendering,
                                 const ReportedProgress& progress, std::stop_token stop) {
  const TwofoldProgress twofold(source, progress);
  ClipSource clip = open_clip_source(source, memory, twofold.finding, stop, open);
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

ExposedPicture expose_forward(ClipSource source, const MemoryBudget& memory, const ExposureRequest& request,
                              ValueType type, const MemoryNeeds& besides, const ExposeStream& expose,
                              std::vector<Note>& notes) {
  std::optional<std::uint64_t> decoded;  // samples, where they are not those announced
  for (;;) {
    try {
      return expose_once(source, decoded.value_or(source.announced_samples()), memory, request, type, besides,
                         expose, notes);
    } catch (const SampleCountMismatch& mismatch) {
      if (decoded == mismatch.sample_count || mismatch.sample_count == 0) {
        throw InputError(format("{}: only {} pictures can be decoded", source.name(), mismatch.sample_count));
      }
      decoded = mismatch.sample_count;
    }
    source = open_clip_source(source.request, memory);
  }
}

}  // namespace nutik
