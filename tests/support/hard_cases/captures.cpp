// Hard cases of codes and storage: rounding edges, saturation, deep codes, tiles of all kinds.
#include <algorithm>
#include <array>

#include "support/hard_cases/parts.hpp"

namespace nutik::test {
namespace {

// Half of code c and half of code c + 1, for every code c: the light lies on the edge between them.
HardCase on_rounding_edges() {
  const CaptureFormat capture = format_of({64, 64, 1}, Transfer::linear(), 4095);
  const Timeline timeline = Timeline::constant({50, 1}, Timeline::kFullShutter, 2);
  const auto code_of = [white = capture.white_code](std::uint64_t i, std::uint64_t k) {
    return std::min<std::uint64_t>(white, i + k);
  };
  return taking_turns(capture, timeline, drawn_by(capture, code_of), {GainFunction::boxcar(0, timeline.duration_ns())});
}

// Light exactly 0 and 1, just inside and outside, and far beyond.
HardCase saturates_at_both_ends() {
  const CaptureFormat capture = format_of({16, 16, 1}, Transfer::srgb());
  const Timeline timeline = Timeline::constant({50, 1}, kHalfShutter, 6);
  const std::int64_t end_ns = timeline.duration_ns();
  std::vector<GainFunction> functions;
  for (const double gain : {1.0, -1.0, 1e4, -1e4, 1.0 + 1e-9, 1.0 - 1e-9, 3.9, -1e-12}) {
    functions.push_back(GainFunction::boxcar(0, end_ns, gain));
  }
  const auto code_of = [](std::uint64_t i, std::uint64_t) { return std::array{0, 1, 254, 255}[i / 8 % 4]; };
  return taking_turns(capture, timeline, drawn_by(capture, code_of), std::move(functions));
}

std::vector<GainFunction> some_functions(const Timeline& timeline) {
  Random random(11);
  std::vector<GainFunction> functions{GainFunction::boxcar(0, timeline.duration_ns())};
  while (functions.size() < 5) functions.push_back(random_function(random, timeline));
  return functions;
}

HardCase codes_of_16_bits() {
  const Timeline timeline = Timeline::constant({30, 1}, kHalfShutter, 70);
  return noisy_case(format_of({9, 9, 1}, Transfer::bt709(), 65'535), timeline, some_functions(timeline));
}

HardCase codes_of_12_bits() {
  const Timeline timeline = Timeline::constant({30, 1}, kHalfShutter, 70);
  return noisy_case(format_of({9, 9, 1}, Transfer::linear(), 4095), timeline, some_functions(timeline));
}

HardCase colour() {
  const Timeline timeline = Timeline::constant({30, 1}, kHalfShutter, 20);
  return noisy_case(format_of({9, 9, 3}, Transfer::bt709()), timeline, some_functions(timeline));
}

// Tiles side by side: still, changed as a whole now and then, changed at every sample, and pixels that
// change once each, all at different samples.
HardCase tiles_of_all_kinds() {
  const CaptureFormat capture = format_of({32, 8, 1}, Transfer::srgb());
  const Timeline timeline = Timeline::constant({30, 1}, kHalfShutter, 64);
  const auto code_of = [](std::uint64_t i, std::uint64_t k) {
    const std::uint64_t y = i / 32, x = i % 32, lane = y * 8 + x % 8;
    const std::uint64_t step = x / 8 == 0 ? 0 : x / 8 == 1 ? k / 10 : x / 8 == 2 ? k : (k + lane) / 64;
    return (lane * 5 + step * 97) % 256;
  };
  HardCase hard = taking_turns(capture, timeline, drawn_by(capture, code_of), some_functions(timeline));
  // A tile of one function beside mixed ones, for kernels read it another way.
  for (std::uint32_t y = 0; y < 4; ++y) {
    for (std::uint32_t x = 0; x < 16; ++x) hard.mask.tags[y * 32 + x] = 1;
  }
  return hard;
}

HardCase blocks_of_one_sample() {
  HardCase hard = tiles_of_all_kinds();
  hard.block_samples = 1;
  return hard;
}

// Three columns of tiles, a few of which change at every sample: its sums take more memory than its one block.
HardCase larger_than_an_allocation() {
  const CaptureFormat capture = format_of({17, 75, 1}, Transfer::srgb());
  const Timeline timeline = Timeline::constant({30, 1}, kHalfShutter, 9);
  const auto code_of = [](std::uint64_t i, std::uint64_t k) {
    const bool changes = i % 17 / 8 == 1 && i / 17 / 8 % 4 == 2;
    return (i * 37 + (changes ? k * 91 : 0)) % 256;
  };
  HardCase hard = taking_turns(capture, timeline, drawn_by(capture, code_of), some_functions(timeline));
  for (std::size_t i = 0; i < hard.mask.tags.size() / 2; ++i) hard.mask.tags[i] = 3;
  return hard;
}

constexpr NamedHardCase kCases[] = {
    {"OnRoundingEdges", "the mean of two neighbouring codes is neither: half up, or within the bound of it",
     on_rounding_edges},
    {"SaturatesAtBothEnds", "light at, near and far beyond 0 and 1", saturates_at_both_ends},
    {"CodesOf16Bits", "65536 codes, the first of them 3e-6 of light apart", codes_of_16_bits},
    {"CodesOf12Bits", "codes of two bytes whose white is not 65535", codes_of_12_bits},
    {"Colour", "three channels of one pixel share records and weights", colour},
    {"TilesOfAllKinds", "still, rows, dense and records in one block, with one function and several",
     tiles_of_all_kinds},
    {"BlocksOfOneSample", "every sample starts a block: no record, no difference of boundaries",
     blocks_of_one_sample},
    {"LargerThanAnAllocation", "more tiles than a small buffer holds: exposed and developed in bands there",
     larger_than_an_allocation},
};

}  // namespace

std::span<const NamedHardCase> hard_captures() { return kCases; }

}  // namespace nutik::test
