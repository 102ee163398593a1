// A walk over the samples of a block that looks only at what changed from one to the next.
//
//   in:      a block, and samples in time order
//   out:     the codes that each tile holds at a sample, and which tiles have others than at the sample before
//   cost:    that of tiles with a change record since the sample before; their rows are not copied
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "imev/block.hpp"

namespace nutik {

class SampleCursor {
 public:
  // The block must outlive it. Sources have checked that its sample numbers increase.
  SampleCursor(const Shape& shape, const BlockView& block);
  SampleCursor(const SampleCursor&) = delete;
  SampleCursor& operator=(const SampleCursor&) = delete;

  // Goes to a sample of the block, which is not before the one it stands at. Returns the tiles in which something
  // changed, increasing; all of them at first. They stay until the next call.
  std::span<const std::uint32_t> go_to(std::uint32_t sample);

  // What a tile holds there: codes [C][64].
  [[nodiscard]] const std::byte* codes(std::uint64_t tile) const { return tiles_[tile].codes; }
  // The code of a channel at a pixel.
  [[nodiscard]] std::uint32_t code(std::uint32_t x, std::uint32_t y, std::uint32_t channel) const;
  // All of it as an interleaved raster of CaptureFormat::sample_bytes().
  void read(std::span<std::byte> raster) const;

 private:
  struct Tile {
    const std::byte* codes = nullptr;
    std::uint32_t row = 0;   // the next one; of tiles of rows
    std::uint32_t next = 0;  // sample at which something changes
  };

  void fetch(std::uint32_t tile, std::uint32_t sample) const;
  void go_to_row(std::uint32_t tile, std::uint32_t sample);
  template <typename Index>
  void gather_records(std::uint32_t tile, std::uint32_t sample);
  template <typename Code, std::uint32_t kChannels>
  void read(Code* raster) const;

  const BlockView& block_;
  Shape shape_;
  TileGrid grid_;
  std::vector<Tile> tiles_;
  std::vector<std::byte> gathered_;  // what tiles hold whose pixels have records of their own
  std::vector<std::uint32_t> changed_;
};

}  // namespace nutik
