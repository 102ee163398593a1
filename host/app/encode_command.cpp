#include <array>

#include "app/capture_input.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/output_name.hpp"
#include "app/progress.hpp"
#include "app/size_text.hpp"
#include "app/stopwatch.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/still_sequence.hpp"
#include "tik/writer.hpp"

namespace nutik::app {
namespace {

std::filesystem::path output_path(const Options& options) {
  const auto stated = stated_output(options.output, options.operands, "encode");
  return stated ? *stated : std::filesystem::path(sequence_name(options.operands.front()) + ".tik");
}

// Everything of one encoding that goes on from sample to sample.
class Encoding {
 public:
  Encoding(SourceClip source, const SourceOptions& options, const tik::Codec& codec,
           const std::string& input, const std::filesystem::path& output)
      : source_(std::move(source)),
        options_(options),
        input_(input),
        builder_(source_.capture, source_.block_samples, options.tiles),
        raster_(source_.capture.sample_bytes()),
        // Before anything is read, so that times that cannot be used are said at once.
        times_(timeline_for(std::max<std::uint64_t>(source_.clip->info().sample_count, 1))) {
    if (!source_.clip->read(raster_)) throw InputError(format("{} has no picture", input));
    tik::Header header;
    header.capture = source_.capture;
    const ClipTiming& timing = source_.clip->info().timing;
    header.rate = options.clip.rate ? options.clip.rate : timing.rate;
    header.shutter_angle = options.shutter_angle;
    writer_.emplace(output, header, codec, raster_);
  }

  Timeline run(Progress& progress) {
    do {
      builder_.add(raster_);
      progress.show(++sample_count_);
      if (builder_.is_full()) write_block();
    } while (source_.clip->read(raster_));
    if (!builder_.is_empty()) write_block();
    Timeline timeline = timeline_for(sample_count_);
    writer_->finish(timeline);
    warn_of_count();
    return timeline;
  }

  [[nodiscard]] std::uint64_t bytes_written() const { return writer_->bytes_written(); }
  [[nodiscard]] const SourceClip& source() const { return source_; }

 private:
  [[nodiscard]] Timeline timeline_for(std::uint64_t samples) const {
    return timeline_of(input_, source_.clip->info(), options_.clip, options_.shutter_angle,
                       samples);
  }

  // Pictures that a decoder leaves out shift all behind them to earlier times.
  void warn_of_count() const {
    const std::uint64_t announced = source_.clip->info().sample_count;
    if (announced == 0 || announced == sample_count_) return;
    print_warning(format(
        "{} announces {} pictures and {} could be decoded: if some within are damaged, those "
        "after them have the times of others",
        input_, announced, sample_count_));
  }

  void write_block() {
    tik::BuiltBlock block{builder_.extent(), {}, builder_.record_count()};
    const std::uint64_t bytes = builder_.finish(payload_);
    block.payload = payload_.first(bytes);
    std::span<const Exposure> exposures;
    if (sample_count_ > times_.sample_count()) times_ = timeline_for(sample_count_);
    if (!times_.is_constant()) {
      exposures = times_.table().subspan(block.extent.first_sample, block.extent.sample_count);
    }
    writer_->append(block, exposures);
  }

  SourceClip source_;
  const SourceOptions& options_;
  std::string input_;
  BlockBuilder builder_;
  std::vector<std::byte> raster_;
  Timeline times_;  // as announced
  PageBuffer payload_;
  std::optional<tik::Writer> writer_;
  std::uint64_t sample_count_ = 0;
};

}  // namespace

int run_encode(const Options& options) {
  const Stopwatch stopwatch;
  const std::filesystem::path output = output_path(options);
  const std::string& input = options.operands.front();
  const SourceOptions source_options = SourceOptions::from(options);
  const tik::Codec codec = options.codec ? tik::Codec::parse(*options.codec) : tik::Codec{};
  if (is_tik(input) && std::filesystem::exists(input)) {
    throw UsageError(format("{} is a capture already; to expose a picture from it: nutik-cl --start 0s "
                            "--exposure 10ms {} picture.png",
                            input, input));
  }
  check_output(output, OutputKind::tik, std::array{input});

  SourceClip source = open_source(input, source_options);
  const ClipInfo info = source.clip->info();
  Encoding encoding(std::move(source), source_options, codec, input, output);
  Progress progress("encoding", info.sample_count, options.quiet);
  const Timeline timeline = encoding.run(progress);
  if (options.quiet) return 0;

  const CaptureFormat& capture = encoding.source().capture;
  print_line(format("{}: {}, {} samples, {}, {} of {} raw, {:.2f} s", output.string(),
                    shape_text(capture.shape), timeline.sample_count(),
                    timing_text(timeline, source_options), bytes_text(encoding.bytes_written()),
                    bytes_text(capture.sample_bytes() * timeline.sample_count()), stopwatch.seconds()));
  for (const std::string& note : info.notes) print_note(format("note: {}", note));
  if (const std::string note = slow_motion_note(timeline, source_options); !note.empty()) {
    print_note(format("note: {}", note));
  }
  return 0;
}

}  // namespace nutik::app
