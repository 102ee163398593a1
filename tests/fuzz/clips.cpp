// open_clip() and all that it calls: the first byte chooses the file's kind, the rest is the file. Every sample is
// read.
#include <vector>

#include "fuzz/target.hpp"
#include "media/clip.hpp"

#ifndef NUTIK_FUZZ_KINDS
#error "NUTIK_FUZZ_KINDS is not set: names of files, in quotes, one for each kind"
#endif

namespace nutik::fuzz {
namespace {

constexpr const char* kKinds[] = {NUTIK_FUZZ_KINDS};

// Inputs have a few kilobytes; a file may still tell of pictures without end.
constexpr std::uint64_t kMaxSamples = 100;
constexpr std::uint64_t kMaxSampleBytes = 64 << 20;

void read(Bytes input) {
  if (input.empty()) return;
  const auto kind = static_cast<std::size_t>(input.front()) % std::size(kKinds);
  ClipOptions options;
  options.white_light = 1.0;  // of floating-point pictures
  const std::unique_ptr<Clip> clip = open_clip(as_file(input.subspan(1), kKinds[kind]), options);
  const CaptureFormat& format = clip->info().format;
  demand(format.shape.value_count() > 0 && format.white_code > 0, "a clip has pixels and a white");
  if (format.sample_bytes() > kMaxSampleBytes) return;
  std::vector<std::byte> raster(format.sample_bytes());
  std::uint64_t samples = 0;
  while (samples < kMaxSamples && clip->read(raster)) ++samples;
  static_cast<void>(timeline_of("clip", clip->info(), {}, Timeline::kFullShutter, samples));
}

}  // namespace

// Decoders keep some pictures of the size that the file tells. FFmpeg reserves room for as many entries of a table as a
// MOV states, up to 2 GB, and touches none of it where the file ends.
#ifdef NUTIK_FUZZ_FFMPEG
const Target kTarget{{std::size_t{1} << 30, 4000, std::size_t{1} << 28}, read};
#else
const Target kTarget{{std::size_t{1} << 30, 4000}, read};
#endif

}  // namespace nutik::fuzz
