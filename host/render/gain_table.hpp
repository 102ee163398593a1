// The packed table of one gain function over a capture (exposure/weight_integrator.hpp), made when it is first needed
// and only for the blocks that the function touches.
//
//   in:      a function and the layout of a capture
//   out:     per block weights and boundaries of the samples that the function needs; what they come to over the
//            capture
//   always:  a function of what it was made from: equal functions over equal captures have equal tables. Numbers are
//            kept run by run (CaptureLayout) as long as TableMemory has room, and made again after that
//   threads: safe from any number
#pragma once

#include <atomic>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "exposure/compensated_sum.hpp"
#include "exposure/function_check.hpp"
#include "exposure/gain_function.hpp"
#include "render/steady_gain.hpp"

namespace nutik {

struct TableRun;

// Keeps parts of gain tables between exposures, the ones used last, as many as a budget allows.
//
//   threads: safe from any number
class TableMemory {
 public:
  explicit TableMemory(std::uint64_t max_bytes) : max_bytes_(max_bytes) {}

  // A number for a table, of its own.
  [[nodiscard]] std::uint64_t new_table();
  // A run of a table; null if it was never made, or was dropped since.
  [[nodiscard]] std::shared_ptr<const TableRun> find(std::uint64_t table, std::size_t run);
  // Keeps a run that was made, and drops those that were not used for longest. Whoever still has one goes on having it.
  void keep(std::uint64_t table, std::size_t run, std::shared_ptr<const TableRun> made);
  // The table is gone.
  void forget(std::uint64_t table);

  [[nodiscard]] std::uint64_t bytes() const;
  // Runs that were made so far, those that had been dropped again.
  [[nodiscard]] std::uint64_t runs_made() const;

 private:
  struct Kept {
    std::pair<std::uint64_t, std::size_t> key;
    std::shared_ptr<const TableRun> run;
  };
  void drop(std::list<Kept>::iterator kept);

  mutable std::mutex mutex_;
  std::uint64_t max_bytes_;
  std::uint64_t bytes_ = 0;
  std::uint64_t tables_ = 0;
  std::uint64_t runs_made_ = 0;
  std::list<Kept> recent_;  // the one used last first
  std::map<std::pair<std::uint64_t, std::size_t>, std::list<Kept>::iterator> places_;
};

struct FunctionCourse;

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
  [[nodiscard]] SteadyGain steady_in(std::uint64_t block) const { return steady_.in(block, *layout_); }
  [[nodiscard]] bool has_corrected() const { return steady_.has_corrected(); }

  // The course of its weights, and of what arithmetics in floating point add up: steady blocks, and their corrections
  // besides. Goes through the whole table the first time.
  [[nodiscard]] const FunctionCourse& course() const;
  [[nodiscard]] const FunctionCourse& parted_course() const;
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
  SteadyStretches steady_;

  mutable std::once_flag measured_;
  mutable std::atomic<bool> is_measured_{false};
  mutable std::unique_ptr<FunctionCourse> course_;
  mutable std::unique_ptr<FunctionCourse> parted_course_;  // none where it is the same
  mutable std::vector<CompensatedSum> before_runs_;        // of the weights before each run
};

}  // namespace nutik
