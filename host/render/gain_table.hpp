// The packed table of one gain function over a capture (exposure/boundary_table.hpp), made when it is first needed and
// only for the blocks that the function touches.
//
//   in:      a function and the layout of a capture
//   out:     per block weights and boundaries of the samples that the function needs; what they come to over the capture
//   always:  a function of what it was made from: equal functions over equal captures have equal tables. Numbers are kept
//            run by run (capture_layout.hpp) as long as TableMemory has room, and made again after that
//   threads: safe from any number
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "exposure/compensated_sum.hpp"
#include "exposure/function_check.hpp"
#include "exposure/gain_function.hpp"
#include "render/capture_layout.hpp"
#include "render/table_memory.hpp"

namespace nutik {

struct FunctionCourse;

// Samples of a block, from its first on: [first, last).
struct SampleSpan {
  std::uint16_t first = 0;
  std::uint16_t last = 0;

  [[nodiscard]] bool empty() const { return first == last; }
  friend bool operator==(const SampleSpan&, const SampleSpan&) = default;
};
static_assert(sizeof(SampleSpan) == 4);

// What a block's light · ns is multiplied by where a function's gain is steady: the same over the whole reach of all
// its samples, and not 0 (docs/explanation/model.md, "Steady gain").
struct SteadyGain {
  double per_ns = 0.0;     // scaled gain / D; 0: the block is not steady
  bool in_bundle = false;  // so are all blocks of its bundle

  [[nodiscard]] bool is_steady() const { return per_ns != 0.0; }
};

// Shorter blocks are not called steady: nothing is gained by what their sums have in common.
inline constexpr std::uint32_t kLeastSteadySamples = 16;

// Blocks b with the same b / kBundleBlocks are a bundle. The capture's last ones are none where some are missing.
inline constexpr std::uint64_t kBundleBlocks = 8;

// The samples that a function needs: whose reach meets its live interval, or all of them.
[[nodiscard]] SampleRange live_samples(const GainSummary& summary, const Timeline& timeline, bool live_all);

// The numbers of one block.
struct BlockTable {
  SampleSpan span;                     // the samples with a weight that may not be 0
  std::span<const double> weights;     // theirs
  std::span<const double> boundaries;  // theirs and one more; none where there is no such sample
  CompensatedSum before;               // of the weights of all blocks before
};

// The numbers of a run of blocks.
struct TableRun {
  struct Block {
    SampleSpan span;
    std::uint64_t offset;  // of its weights, then its boundaries
    CompensatedSum before;
  };
  std::uint64_t first_block = 0;
  std::vector<Block> blocks;
  std::vector<double> numbers;
  CompensatedSum after;  // of the weights up to its end

  [[nodiscard]] BlockTable table(std::uint64_t block) const;
  [[nodiscard]] std::uint64_t bytes() const {
    return sizeof *this + blocks.size() * sizeof(Block) + numbers.size() * sizeof(double);
  }
};

class GainTable {
 public:
  // `live_all`: every sample is needed, also where the gain is 0. `support_ns`: D, if it is not the function's own.
  GainTable(GainFunction function, bool live_all, std::shared_ptr<const CaptureLayout> layout,
            std::shared_ptr<TableMemory> memory, std::optional<std::int64_t> support_ns = {});
  ~GainTable();
  GainTable(const GainTable&) = delete;
  GainTable& operator=(const GainTable&) = delete;

  [[nodiscard]] const GainFunction& function() const { return function_; }
  [[nodiscard]] bool is_live_everywhere() const { return live_all_; }
  [[nodiscard]] const GainSummary& summary() const { return summary_; }
  // What the function and the capture's domain have to do with each other (check_domain).
  [[nodiscard]] const std::vector<FunctionFinding>& findings() const { return findings_; }
  // The samples that it needs, in the capture and in a block.
  [[nodiscard]] const SampleRange& live() const { return live_; }
  [[nodiscard]] SampleSpan span_in(const BlockExtent& block) const;
  [[nodiscard]] SteadyGain steady_in(std::uint64_t block) const;

  // Goes through the whole table the first time.
  [[nodiscard]] const FunctionCourse& course() const;
  [[nodiscard]] bool is_measured() const { return is_measured_; }

  // Reads blocks one after another.
  class Reader {
   public:
    explicit Reader(const GainTable& table) : table_(table) {}
    // Stays until the next call.
    [[nodiscard]] BlockTable block(std::uint64_t block);

   private:
    const GainTable& table_;
    std::shared_ptr<const TableRun> run_;
  };

 private:
  // Where the gain is the same, longer than a piece perhaps.
  struct SteadyStretch {
    std::int64_t begin_ns;
    std::int64_t end_ns;
    double gain_per_ns;
  };

  [[nodiscard]] std::vector<SteadyStretch> steady_stretches() const;
  // That holds the reach of these blocks' samples; null where none does.
  [[nodiscard]] const SteadyStretch* stretch_of(std::uint64_t first_block, std::uint64_t last_block) const;
  void measure() const;
  [[nodiscard]] bool touches(std::size_t run) const;
  [[nodiscard]] std::shared_ptr<const TableRun> run(std::size_t run) const;
  [[nodiscard]] std::shared_ptr<const TableRun> make_run(std::size_t run, CompensatedSum before) const;

  GainFunction function_;
  bool live_all_;
  std::shared_ptr<const CaptureLayout> layout_;
  std::shared_ptr<TableMemory> memory_;
  std::uint64_t id_;  // in the memory
  GainSummary summary_;
  std::vector<FunctionFinding> findings_;
  SampleRange live_;
  std::vector<SteadyStretch> steady_;  // in time order

  mutable std::once_flag measured_;
  mutable std::atomic<bool> is_measured_{false};
  mutable std::unique_ptr<FunctionCourse> course_;
  mutable std::vector<CompensatedSum> before_runs_;  // of the weights before each run
};

}  // namespace nutik
