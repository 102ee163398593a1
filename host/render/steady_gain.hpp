// Where a function's gain is steady, and which blocks are added up before it is multiplied
// (docs/explanation/model.md, "Steady gain").
//
//   in:      a gain function, the layout of a capture
//   out:     by block its steady gain, the bundle that it is one of, and the samples of which the gain is another one
//   always:  a function of the function, the timeline and the blocks alone
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "exposure/gain_function.hpp"
#include "imev/capture_source.hpp"

namespace nutik {

// From a block's first sample to its last one.
struct BlockReach {
  std::int64_t begin_ns;
  std::int64_t end_ns;
};

// When a capture's samples were exposed, and which blocks hold them: all that tables of gain functions depend on
// beside the functions.
//
//   always:  immutable and shared by the tables that were made for it
struct CaptureLayout {
  // Samples of a run of blocks at least, so that neither a table's runs nor the bookkeeping of them take much.
  static constexpr std::uint64_t kRunSamples = 1u << 14;

  Timeline timeline;
  std::vector<BlockExtent> blocks;
  std::vector<BlockReach> reaches;        // of the blocks
  std::vector<std::uint64_t> run_starts;  // the first block of each run, and one behind the last

  [[nodiscard]] static std::shared_ptr<const CaptureLayout> of(const CaptureSource& source);

  [[nodiscard]] std::size_t run_count() const { return run_starts.size() - 1; }
  [[nodiscard]] std::size_t run_of(std::uint64_t block) const;
  // The samples of a run.
  [[nodiscard]] SampleRange samples(std::size_t run) const;
  // Whether tables of this layout are those of the source.
  [[nodiscard]] bool is_of(const CaptureSource& source) const;
};

// Samples of a block, from its first on: [first, last).
struct SampleSpan {
  std::uint16_t first = 0;
  std::uint16_t last = 0;

  [[nodiscard]] bool empty() const { return first == last; }
  friend bool operator==(const SampleSpan&, const SampleSpan&) = default;
};
static_assert(sizeof(SampleSpan) == 4);

// Shorter blocks are not called steady: nothing is gained by what their sums have in common.
inline constexpr std::uint32_t kMinSteadySamples = 16;

// Blocks b with the same b / kGroupBlocks are a group; the capture's last one may have fewer.
inline constexpr std::uint64_t kGroupBlocks = 16;

// The first half of a block of n samples has ⌊n / 2⌋.
enum class Halves : std::uint8_t { both, first, second };
[[nodiscard]] SampleSpan samples_of(Halves halves, const BlockExtent& block);

// Neighbouring blocks whose light · ns is added up: one, half of one, or a bundle. A bundle is of one group, and has
// its first block or its last one.
struct SummedBlocks {
  std::uint64_t first = 0;
  std::uint64_t count = 1;
  Halves halves = Halves::both;

  [[nodiscard]] std::uint64_t last() const { return first + count - 1; }
  [[nodiscard]] bool is_bundle() const { return count > 1; }
  // Among all that a block may be summed in: 0 for itself, less than 32.
  [[nodiscard]] std::uint32_t index() const;
  friend auto operator<=>(const SummedBlocks&, const SummedBlocks&) = default;
};

// What the light · ns of a block, or of half of it, is multiplied by: the function's gain over the reach of its
// samples, the same for all of them but the corrected ones, and not 0.
struct SteadyGain {
  double per_ns = 0.0;  // scaled gain / D; 0: the block is not steady
  SummedBlocks bundle;  // that the block is one of, or half of
  SampleSpan
      corrected;  // samples that are given another weight besides: less than half of the block, at one side

  [[nodiscard]] bool is_steady() const { return per_ns != 0.0; }
};

// ∫φ of a block's samples in ns, and their sums from the first of them on. All are whole halves of nanoseconds.
struct HatNumbers {
  SampleSpan span;
  std::vector<double> weights;
  std::vector<double> boundaries;
};
[[nodiscard]] HatNumbers hats_of(const BlockExtent& block, const Timeline& timeline,
                                 Halves halves = Halves::both);

// What a block's corrected samples have beside its steady gain, and sums of that from the first of them on. `weights`
// are those of the samples in `live`, the function's own.
struct CorrectionNumbers {
  std::vector<double> weights;
  std::vector<double> boundaries;
};
[[nodiscard]] CorrectionNumbers correction_of(const SteadyGain& steady, const HatNumbers& hats,
                                              SampleSpan live, std::span<const double> weights);

class SteadyStretches {
 public:
  // `live` are the samples that the function needs.
  SteadyStretches(const GainFunction& function, const GainSummary& summary, const SampleRange& live,
                  const CaptureLayout& layout);

  [[nodiscard]] SteadyGain in(std::uint64_t block, const CaptureLayout& layout) const;
  // Whether some block has corrected samples.
  [[nodiscard]] bool has_corrected() const { return has_corrected_; }

 private:
  // A block that an end of a stretch cuts: what counts as steady, and what is corrected.
  struct Cut {
    Halves halves = Halves::both;
    SampleSpan corrected;
  };
  // Blocks [first, last) over the reach of whose samples the gain is the same, those that are cut included.
  struct Stretch {
    double per_ns;
    std::uint64_t first;
    std::uint64_t last;
    Cut first_cut;
    Cut last_cut;
  };
  static std::optional<Cut> better_cut(const BlockExtent& block, const Cut& whole, const Cut& half,
                                       std::uint32_t live_samples);
  static void extend(Stretch& stretch, std::int64_t begin_ns, std::int64_t end_ns, const SampleRange& live,
                     const CaptureLayout& layout);

  std::vector<Stretch> stretches_;  // in time order
  bool has_corrected_ = false;
};

}  // namespace nutik
