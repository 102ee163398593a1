// When a capture's samples were exposed, and which blocks hold them: all that tables of gain functions depend on
// beside the functions.
//
//   always:  immutable and shared by the tables that were made for it
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "imev/capture_source.hpp"

namespace nutik {

// Of a block's samples, from the first one's to the last one's.
struct BlockReach {
  std::int64_t begin_ns;
  std::int64_t end_ns;
};

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

}  // namespace nutik
