// Three stages side by side, so that decoding goes on while a block is closed, packed and written.
//
//   a thread        decodes samples               │ rasters, reused (media/read_ahead.hpp); not of clips that tell
//                                                 │ changes, which are decoded already
//   the caller's    builds blocks from them       │ payloads, reused
//   another         packs and writes the blocks
#include "session/clips/encoding.hpp"

#include <algorithm>
#include <future>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "imev/block_builder.hpp"
#include "imev/expected_values.hpp"
#include "media/input_checksum.hpp"
#include "media/read_ahead.hpp"
#include "media/stills/still_sequence.hpp"
#include "session/output_check.hpp"
#include "system/channel.hpp"
#include "system/interruption.hpp"
#include "system/parallel.hpp"
#include "tik/writer.hpp"

namespace nutik {
namespace {

constexpr std::size_t kPayloads = 1;  // besides the one that is being built

class Encoding {
 public:
  // Reads the first sample.
  Encoding(ClipSource source, const EncodeRequest& request, const ClipMemory& memory)
      : source_(std::move(source)),
        builder_(source_.capture, memory.blocks, source_.request.tiles, half_the_cores()),
        // Before anything is read, so that times that cannot be used are said at once.
        times_(source_.timeline(std::max<std::uint64_t>(source_.announced_samples(), 1))),
        codec_(request.codec),
        blocks_(kPayloads),
        spare_payloads_(kPayloads) {
    read_first(memory.read_ahead_bytes);
    if (first_.empty()) throw InputError(format("{} has no picture", source_.name()));
    tik::Header header;
    header.capture = held_format(source_.capture);
    const std::optional<Rational>& stated_rate = source_.request.clip.rate;
    if (!source_.made) header.rate = stated_rate ? stated_rate : source_.clip->info().timing.rate;
    header.shutter_angle = times_.shutter_angle();
    for (const Fact& fact : source_.facts(times_.sample_count())) header.facts.push_back(fact.line());
    header.is_scaled = source_.request.clip.scale.has_value();
    header.roundings = source_.clip->info().roundings;
    header.part = source_.clip->info().part;
    // A capture without a name is joined to none.
    if (header.part && request.lasting != OutputFile::Lasting::no)
      header.part->checksum = input_checksum(source_.request.path, source_.request.clip.raw.has_value());
    if (source_.camera) header.alignment = kept_alignment(**source_.camera, source_.request.align->unseen);
    if (source_.made) {
      header.made = **source_.made;
      header.filmed = tik::filmed_times(source_.filmed(0));
    }
    writer_.emplace(request.output, header, request.codec, to_held_codes(source_.capture, first_.front()),
                    memory.threads, request.lasting);
    for (std::size_t i = 0; i < kPayloads; ++i) spare_payloads_.push(PageBuffer());
  }

  EncodedCapture run(const ReportedProgress& told, const std::stop_token& stop) {
    // Reading waits for a slow codec, which tells itself how far it is: this thread is silent then.
    const bool is_slow = codec_.is_slow();
    const ReportedProgress progress = is_slow ? ReportedProgress() : told;
    writer_->tell_of_packing([&](std::uint64_t done, std::uint64_t total) {
      if (stop.stop_requested()) throw Cancelled();
      if (is_slow && told) told(packed_ + done * packing_ / total, source_.announced_samples());
    });
    auto storing = std::async(std::launch::async, [this] { store(); });
    const std::uint64_t samples = samples_ ? build(progress, stop) : build_of_changes(progress, stop);
    storing.get();
    if (is_slow && told) told(samples, source_.announced_samples());
    Timeline timeline = source_.timeline(samples);
    writer_->finish(timeline);
    std::vector<Fact> facts = source_.facts(samples);
    std::ranges::move(source_.clip->remarks(), std::back_inserter(source_.notes));
    std::vector<Note> notes = source_.all_notes(samples);
    return {source_.capture,  std::move(timeline), writer_->bytes_written(),
            std::move(facts), std::move(notes),    warnings(samples),
            source_.camera,   source_.sound()};
  }

 private:
  struct Block {
    BlockExtent extent;
    PageBuffer payload;
    FinishedBlock finished;
  };

  [[nodiscard]] std::vector<std::string> warnings(std::uint64_t samples) const {
    auto reason = source_.clip->ended_early();
    if (!reason) reason = lost_pictures_text(source_.name(), source_.announced_samples(), samples);
    return reason ? std::vector{std::move(*reason)} : std::vector<std::string>();
  }

  // Returns how many samples there were.
  std::uint64_t build(const ReportedProgress& progress, const std::stop_token& stop) {
    const ClosedAtEnd closed(blocks_);
    std::uint64_t samples = 0;
    for (auto rasters = first_; !rasters.empty();
         rasters = samples_->next(std::min(builder_.room(), BlockBuilder::kSamplesAtOnce))) {
      check_interruption();
      if (stop.stop_requested()) throw Cancelled();
      samples += rasters.size();
      if (progress) progress(samples, source_.announced_samples());
      builder_.add(rasters);
      if (builder_.is_full() && !hand_over_block(stop)) return samples;
    }
    if (!builder_.is_empty()) hand_over_block(stop);
    return samples;
  }

  // The same of a clip that tells changes.
  std::uint64_t build_of_changes(const ReportedProgress& progress, const std::stop_token& stop) {
    constexpr std::uint64_t kSamplesBetweenLooks = 256;
    const ClosedAtEnd closed(blocks_);
    std::uint64_t samples = 0;
    for (bool is_read = true;; ++samples) {
      if (samples % kSamplesBetweenLooks == 0) {
        check_interruption();
        if (stop.stop_requested()) throw Cancelled();
        if (progress) progress(samples, source_.announced_samples());
      }
      // A block starts from all pixels.
      if (builder_.is_empty()) {
        if (!is_read && !source_.clip->read(raster_)) break;
        builder_.add(raster_);
      } else {
        const auto changes = source_.clip->read_changes();
        if (!changes) break;
        builder_.add_changes(*changes);
      }
      is_read = false;
      if (builder_.is_full() && !hand_over_block(stop)) return samples + 1;
    }
    if (!builder_.is_empty()) hand_over_block(stop);
    return samples;
  }

  void read_first(std::uint64_t read_ahead_bytes) {
    if (!source_.clip->tells_changes() || !builder_.takes_changes()) {
      samples_.emplace(*source_.clip, read_ahead_bytes);
      first_ = samples_->next(1);
      return;
    }
    raster_.resize(source_.capture.sample_bytes());
    raster_span_ = raster_;
    if (source_.clip->read(raster_)) first_ = {&raster_span_, 1};
  }

  // False where nobody stores blocks any more.
  bool hand_over_block(const std::stop_token& stop) {
    auto payload = spare_payloads_.pop();
    if (!payload) return false;
    Block block{builder_.extent(), std::move(*payload), {}};
    block.finished = builder_.finish(block.payload, stop);
    return blocks_.push(std::move(block));
  }

  void store() {
    const ClosedAtEnd closed(blocks_, spare_payloads_);
    while (auto block = blocks_.pop()) {
      const SampleRange range = block->extent.range();
      if (range.last > times_.sample_count()) times_ = source_.timeline(range.last);
      std::span<const Exposure> exposures;
      if (!times_.is_constant()) {
        exposures = times_.table().subspan(range.first, block->extent.sample_count);
      }
      packed_ = range.first;
      packing_ = block->extent.sample_count;
      writer_->append(
          {block->extent, block->payload.first(block->finished.span_bytes), block->finished.record_count},
          exposures);
      spare_payloads_.push(std::move(block->payload));
    }
  }

  ClipSource source_;
  BlockBuilder builder_;
  Timeline times_;  // as announced
  std::optional<tik::Writer> writer_;
  tik::Codec codec_;
  std::uint64_t packed_ = 0, packing_ = 0;  // samples of the blocks before, and of the one that is packed

  std::optional<ReadAhead> samples_;  // none of a clip whose changes are read
  std::vector<std::byte> raster_;     // of such a clip
  std::span<const std::byte> raster_span_;
  std::span<const std::span<const std::byte>> first_;  // the first sample, until the next are asked for
  Channel<Block> blocks_;                              // built
  Channel<PageBuffer> spare_payloads_;
};

}  // namespace

EncodedCapture encode(ClipSource source, const EncodeRequest& request, const ClipMemory& memory,
                      const ReportedProgress& progress, std::stop_token stop) {
  source.check();
  return Encoding(std::move(source), request, memory).run(progress, stop);
}

EncodedCapture encode(const SourceRequest& source, const EncodeRequest& request, const MemoryBudget& memory,
                      const ReportedProgress& progress, std::stop_token stop, const OpenClip& open) {
  std::vector<std::string> inputs;
  if (!open) {
    inputs.push_back(source.path.string());
    for (const auto& still : list_stills(source.path).value_or(std::vector<std::filesystem::path>{}))
      inputs.push_back(still.string());
  }
  check_output(request.output, OutputKind::tik, inputs);
  const TwofoldProgress twofold(source, progress);
  ClipSource clip = open_clip_source(source, memory, twofold.finding, stop, open);
  const ClipMemory shares = memory_for_encoding(memory, clip.clip_to_read());
  return encode(std::move(clip), request, shares, twofold.reading, std::move(stop));
}

}  // namespace nutik
