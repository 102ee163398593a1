#include "app/input/encoding.hpp"

#include <algorithm>
#include <future>

#include "app/output/console.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "imev/expected_values.hpp"
#include "system/interruption.hpp"

namespace nutik::app {
namespace {

constexpr std::size_t kPayloads = 1;  // besides the one that is being built

}  // namespace

Encoding::Encoding(SourceClip source, const SourceOptions& options, const tik::Codec& codec,
                   const std::string& input, const std::filesystem::path& output)
    : source_(std::move(source)),
      options_(options),
      input_(input),
      builder_(source_.capture, source_.block_samples, options.tiles),
      // Before anything is read, so that times that cannot be used are said at once.
      times_(timeline_for(std::max<std::uint64_t>(source_.clip->info().sample_count, 1))),
      samples_(*source_.clip, options.memory.read_ahead_bytes()),
      first_(samples_.next(1)),
      blocks_(kPayloads),
      spare_payloads_(kPayloads) {
  if (first_.empty()) throw InputError(format("{} has no picture", input));
  tik::Header header;
  header.capture = held_format(source_.capture);
  const ClipTiming& timing = source_.clip->info().timing;
  header.rate = options.clip.rate ? options.clip.rate : timing.rate;
  header.shutter_angle = times_.shutter_angle();
  writer_.emplace(output, header, codec, to_held_codes(source_.capture, first_.front()));
  for (std::size_t i = 0; i < kPayloads; ++i) spare_payloads_.push(PageBuffer());
}

Timeline Encoding::run(Progress& progress) {
  auto storing = std::async(std::launch::async, [this] { store(); });
  const std::uint64_t samples = build(progress);
  storing.get();
  Timeline timeline = timeline_for(samples);
  writer_->finish(timeline);
  warn_of_count(samples);
  return timeline;
}

Timeline Encoding::timeline_for(std::uint64_t samples) const {
  return timeline_of(input_, source_.clip->info(), options_.clip, options_.shutter_angle, samples);
}

// Pictures that a decoder leaves out shift all behind them to earlier times.
void Encoding::warn_of_count(std::uint64_t samples) const {
  const std::uint64_t announced = source_.clip->info().sample_count;
  if (announced == 0 || announced == samples) return;
  print_warning(
      format("{} announces {} pictures and {} could be decoded: if some within are damaged, those "
             "after them have the times of others",
             input_, announced, samples));
}

std::uint64_t Encoding::build(Progress& progress) {
  const ClosedAtEnd closed(blocks_);
  std::uint64_t samples = 0;
  for (auto rasters = first_; !rasters.empty();
       rasters = samples_.next(std::min(builder_.room(), BlockBuilder::kSamplesAtOnce))) {
    check_interruption();
    samples += rasters.size();
    progress.show(samples);
    builder_.add(rasters);
    if (builder_.is_full() && !hand_over_block()) return samples;
  }
  if (!builder_.is_empty()) hand_over_block();
  return samples;
}

bool Encoding::hand_over_block() {
  auto payload = spare_payloads_.pop();
  if (!payload) return false;
  Block block{builder_.extent(), std::move(*payload), {}};
  block.finished = builder_.finish(block.payload);
  return blocks_.push(std::move(block));
}

void Encoding::store() {
  const ClosedAtEnd closed(blocks_, spare_payloads_);
  while (auto block = blocks_.pop()) {
    const SampleRange range = block->extent.range();
    if (range.last > times_.sample_count()) times_ = timeline_for(range.last);
    std::span<const Exposure> exposures;
    if (!times_.is_constant()) {
      exposures = times_.table().subspan(range.first, block->extent.sample_count);
    }
    writer_->append(
        {block->extent, block->payload.first(block->finished.span_bytes), block->finished.record_count},
        exposures);
    spare_payloads_.push(std::move(block->payload));
  }
}

}  // namespace nutik::app
