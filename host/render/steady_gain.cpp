#include "render/steady_gain.hpp"

#include <algorithm>
#include <cmath>

#include "exposure/compensated_sum.hpp"

namespace nutik {
namespace {

// A smaller one could leave the range of single precision with the light · ns that it is multiplied to.
constexpr double kMinSteadyGain = 0x1p-100;

// Blocks that a stretch covers wholly before those that its ends cut are corrected: what is read of these besides,
// where no sums are kept, is little beside all that is read.
constexpr std::uint64_t kMinCorrectedBlocks = kGroupBlocks;

bool is_long(const BlockExtent& block) { return block.sample_count >= kMinSteadySamples; }

// The first of a block's samples, from its first on, that `is_it`, as are all behind it.
template <typename Is>
std::uint32_t first_sample(const BlockExtent& block, Is is_it) {
  std::uint32_t first = 0, last = block.sample_count;
  while (first < last) {
    const std::uint32_t middle = (first + last) / 2;
    if (is_it(block.first_sample + middle)) {
      last = middle;
    } else {
      first = middle + 1;
    }
  }
  return first;
}

SampleSpan span_of(std::uint32_t first, std::uint32_t last) {
  return {static_cast<std::uint16_t>(first), static_cast<std::uint16_t>(last)};
}

std::uint32_t size_of(const SampleSpan& span) { return std::uint32_t{span.last} - span.first; }

// The number of a block's samples before the capture's sample `sample`.
std::uint32_t samples_before(std::uint64_t sample, const BlockExtent& block) {
  const SampleRange samples = block.range();
  return static_cast<std::uint32_t>(std::clamp(sample, samples.first, samples.last) - samples.first);
}

}  // namespace

std::shared_ptr<const CaptureLayout> CaptureLayout::of(const CaptureSource& source) {
  auto layout = std::make_shared<CaptureLayout>(CaptureLayout{source.timeline(), {}, {}, {}});
  std::uint64_t samples = kRunSamples;
  for (std::uint64_t block = 0; block < source.block_count(); ++block) {
    if (samples >= kRunSamples) {
      layout->run_starts.push_back(block);
      samples = 0;
    }
    const BlockExtent& extent = layout->blocks.emplace_back(source.block_extent(block));
    layout->reaches.push_back({layout->timeline.reach_begin_ns(extent.first_sample),
                               layout->timeline.reach_end_ns(extent.range().last - 1)});
    samples += layout->blocks.back().sample_count;
  }
  layout->run_starts.push_back(layout->blocks.size());
  return layout;
}

std::size_t CaptureLayout::run_of(std::uint64_t block) const {
  return static_cast<std::size_t>(std::ranges::upper_bound(run_starts, block) - run_starts.begin()) - 1;
}

SampleRange CaptureLayout::samples(std::size_t run) const {
  return {blocks[run_starts[run]].first_sample, blocks[run_starts[run + 1] - 1].range().last};
}

bool CaptureLayout::is_of(const CaptureSource& source) const {
  if (source.block_count() != blocks.size()) return false;
  for (std::uint64_t block = 0; block < blocks.size(); ++block) {
    if (source.block_extent(block) != blocks[block]) return false;
  }
  return source.timeline() == timeline;
}

SampleSpan samples_of(Halves halves, const BlockExtent& block) {
  const std::uint32_t half = block.sample_count / 2;
  return span_of(halves == Halves::second ? half : 0, halves == Halves::first ? half : block.sample_count);
}

std::uint32_t SummedBlocks::index() const {
  if (halves != Halves::both) return halves == Halves::first ? 30 : 31;
  if (count == 1) return 0;
  const std::uint64_t at = first % kGroupBlocks;
  // From the group's first block on 2 … 16 of them, else from a later one on all that are left.
  return static_cast<std::uint32_t>(at == 0 ? kGroupBlocks - 3 + count : at);
}

HatNumbers hats_of(const BlockExtent& block, const Timeline& timeline, Halves halves) {
  HatNumbers hats{samples_of(halves, block), {}, {0.0}};
  hats.weights.reserve(size_of(hats.span));
  hats.boundaries.reserve(size_of(hats.span) + 1);
  std::uint64_t half_ns = 0;
  for (const SampleTimes& sample :
       timeline.times({block.first_sample + hats.span.first, block.first_sample + hats.span.last})) {
    const auto exposed = static_cast<std::uint64_t>(sample.end_ns - sample.start_ns);
    const auto before = static_cast<std::uint64_t>(sample.start_ns - sample.before_ns);
    const auto after = static_cast<std::uint64_t>(sample.after_ns - sample.end_ns);
    const bool holds_to_the_end = sample.after_ns == timeline.duration_ns();
    const std::uint64_t hat = 2 * exposed + before + (holds_to_the_end ? 2 : 1) * after;
    half_ns += hat;
    hats.weights.push_back(static_cast<double>(hat) / 2);
    hats.boundaries.push_back(static_cast<double>(half_ns) / 2);
  }
  return hats;
}

CorrectionNumbers correction_of(const SteadyGain& steady, const HatNumbers& hats, SampleSpan live,
                                std::span<const double> weights) {
  CorrectionNumbers numbers{{}, {0.0}};
  CompensatedSum boundary;
  for (std::uint32_t k = steady.corrected.first; k < steady.corrected.last; ++k) {
    const double weight = k >= live.first && k < live.last ? weights[k - live.first] : 0.0;
    const bool is_steady = k >= hats.span.first && k < hats.span.last;
    numbers.weights.push_back(is_steady ? weight - steady.per_ns * hats.weights[k - hats.span.first]
                                        : weight);
    boundary.add(numbers.weights.back());
    numbers.boundaries.push_back(boundary.value());
  }
  return numbers;
}

SteadyStretches::SteadyStretches(const GainFunction& function, const GainSummary& summary,
                                 const SampleRange& live, const CaptureLayout& layout) {
  std::int64_t begin_ns = 0, end_ns = 0;
  double per_ns = 0.0;
  const auto close = [&] {
    if (per_ns == 0.0) return;
    const auto first = std::ranges::lower_bound(layout.reaches, begin_ns, {}, &BlockReach::begin_ns);
    const auto last = std::ranges::upper_bound(layout.reaches, end_ns, {}, &BlockReach::end_ns);
    if (first >= last) return;
    Stretch stretch{per_ns,
                    static_cast<std::uint64_t>(first - layout.reaches.begin()),
                    static_cast<std::uint64_t>(last - layout.reaches.begin()),
                    {},
                    {}};
    extend(stretch, begin_ns, end_ns, live, layout);
    has_corrected_ |= !stretch.first_cut.corrected.empty() || !stretch.last_cut.corrected.empty();
    stretches_.push_back(stretch);
  };
  for (const GainPiece& piece : function.pieces(layout.timeline.duration_ns())) {
    if (piece.begin_gain != piece.end_gain) continue;
    const double gain_per_ns =
        std::scalbn(piece.begin_gain, -summary.exponent) / static_cast<double>(summary.support_ns);
    if (!(std::fabs(gain_per_ns) >= kMinSteadyGain)) continue;
    if (end_ns != piece.begin_ns || per_ns != gain_per_ns) {
      close();
      begin_ns = piece.begin_ns;
      per_ns = gain_per_ns;
    }
    end_ns = piece.end_ns;
  }
  close();
}

// What leaves fewest samples to be read beside a kept sum. A half is a sum more, which has to be made: it must save
// more than an eighth of the block, beside the whole's corrections and beside the samples that the function needs of
// it.
std::optional<SteadyStretches::Cut> SteadyStretches::better_cut(const BlockExtent& block, const Cut& whole,
                                                                const Cut& half, std::uint32_t live_samples) {
  const std::uint32_t of_half = size_of(half.corrected), of_whole = size_of(whole.corrected);
  const auto is_short = [&](std::uint32_t corrected) { return 2 * corrected < block.sample_count; };
  if (size_of(samples_of(half.halves, block)) >= kMinSteadySamples && is_short(of_half) &&
      of_half + block.sample_count / 8 < std::min(of_whole, live_samples)) {
    return half;
  }
  if (is_short(of_whole)) return whole;
  return {};
}

void SteadyStretches::extend(Stretch& stretch, std::int64_t begin_ns, std::int64_t end_ns,
                             const SampleRange& live, const CaptureLayout& layout) {
  if (stretch.last - stretch.first < kMinCorrectedBlocks) return;
  const Timeline& timeline = layout.timeline;
  if (stretch.first > 0 && is_long(layout.blocks[stretch.first - 1])) {
    const BlockExtent& block = layout.blocks[stretch.first - 1];
    const std::uint32_t count = block.sample_count, middle = samples_of(Halves::second, block).first;
    const std::uint32_t steady =
        first_sample(block, [&](std::uint64_t k) { return timeline.reach_begin_ns(k) >= begin_ns; });
    const std::uint32_t first_live = samples_before(live.first, block);
    const auto cut =
        better_cut(block, {Halves::both, span_of(0, steady)},
                   {Halves::second, span_of(std::min(first_live, middle), std::max(steady, middle))},
                   count - first_live);
    if (cut) {
      stretch.first_cut = *cut;
      --stretch.first;
    }
  }
  if (stretch.last < layout.blocks.size() && is_long(layout.blocks[stretch.last])) {
    const BlockExtent& block = layout.blocks[stretch.last];
    const std::uint32_t count = block.sample_count, middle = samples_of(Halves::first, block).last;
    const std::uint32_t steady =
        first_sample(block, [&](std::uint64_t k) { return timeline.reach_end_ns(k) > end_ns; });
    const std::uint32_t last_live = samples_before(live.last, block);
    const auto cut = better_cut(
        block, {Halves::both, span_of(steady, count)},
        {Halves::first, span_of(std::min(steady, middle), std::max(last_live, middle))}, last_live);
    if (cut) {
      stretch.last_cut = *cut;
      ++stretch.last;
    }
  }
}

SteadyGain SteadyStretches::in(std::uint64_t block, const CaptureLayout& layout) const {
  if (!is_long(layout.blocks[block])) return {};
  const auto after = std::ranges::upper_bound(stretches_, block, {}, &Stretch::first);
  if (after == stretches_.begin()) return {};
  const Stretch& stretch = *std::prev(after);
  if (block >= stretch.last) return {};
  Cut cut;
  if (block == stretch.first) {
    cut = stretch.first_cut;
  } else if (block + 1 == stretch.last) {
    cut = stretch.last_cut;
  }
  SteadyGain steady{stretch.per_ns, {block, 1, cut.halves}, cut.corrected};
  if (cut.halves != Halves::both) return steady;
  // As far as steady blocks reach in the group.
  const std::uint64_t whole_first = stretch.first + (stretch.first_cut.halves != Halves::both);
  const std::uint64_t whole_last = stretch.last - (stretch.last_cut.halves != Halves::both);
  const std::uint64_t group = block / kGroupBlocks * kGroupBlocks;
  const std::uint64_t group_end = std::min<std::uint64_t>(group + kGroupBlocks, layout.blocks.size());
  std::uint64_t first = block, last = block + 1;
  while (first > std::max(group, whole_first) && is_long(layout.blocks[first - 1])) --first;
  while (last < std::min(group_end, whole_last) && is_long(layout.blocks[last])) ++last;
  if (first == group || last == group_end) steady.bundle = {first, last - first};
  return steady;
}

}  // namespace nutik
