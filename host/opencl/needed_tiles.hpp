// Which tiles of a block an exposure reads: what need not be unpacked of a packed capture.
//
//   in:      a plan, the bands that are exposed, with their functions
//   out:     for a planned block, whether kernels read any of a run of tiles
//   always:  a tile is read where its function needs samples of the block. One whose pixels have several functions is
//            read in every planned block, for kernels look at each of its samples; with delays (exposure/delay_map.hpp)
//            where any of its pixels needs some
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "imev/block_lease.hpp"
#include "opencl/developer.hpp"
#include "render/render_plan.hpp"

namespace nutik {

class NeededTiles {
 public:
  // Both must outlive this.
  NeededTiles(const RenderPlan& plan, std::span<const ExposedBand> bands) : plan_(plan), bands_(bands) {}

  // For the terms of a planned block's lease; to be asked by one thread at a time.
  [[nodiscard]] WantsTiles of(const PlannedBlock& planned) const;

  // Whether the block's tiles that are read are all among `there`, one flag for each of the picture.
  [[nodiscard]] bool are_among(const std::vector<bool>& there, const PlannedBlock& planned) const;

 private:
  static constexpr std::uint32_t kUnread = 0xFFFF'FFFE;  // outside all bands

  [[nodiscard]] const std::vector<std::uint32_t>& functions() const;
  // With delays: whether a tile is in a band and has a pixel that needs one of the samples.
  [[nodiscard]] bool is_exposed(std::uint64_t tile, const SampleRange& samples) const;
  // By function, whether it needs samples of the block.
  [[nodiscard]] std::vector<bool> live_in(const PlannedBlock& planned) const;

  const RenderPlan& plan_;
  std::span<const ExposedBand> bands_;
  mutable std::vector<std::uint32_t> functions_;  // by tile of the picture; empty until they are asked for
  mutable std::vector<SampleRange> needs_;        // with delays: those of a tile's pixels, likewise
};

}  // namespace nutik
