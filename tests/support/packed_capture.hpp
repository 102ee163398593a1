// A capture whose blocks are unpacked in groups of tiles, as those of a packed file are.
//
//   always:  bodies of groups that nobody wants are garbage, sample numbers included: who reads them shows it
#pragma once

#include <algorithm>
#include <atomic>
#include <memory>

#include "imev/capture_source.hpp"

namespace nutik::test {

class PackedCapture final : public CaptureSource {
 public:
  PackedCapture(MemoryCapture& capture, std::uint64_t group_tiles)
      : capture_(capture), group_tiles_(group_tiles) {}

  [[nodiscard]] const CaptureFormat& format() const override { return capture_.format(); }
  [[nodiscard]] const Timeline& timeline() const override { return capture_.timeline(); }
  [[nodiscard]] std::uint64_t block_count() const override { return capture_.block_count(); }
  [[nodiscard]] BlockExtent block_extent(std::uint64_t block) const override {
    return capture_.block_extent(block);
  }
  [[nodiscard]] std::uint64_t lent_bytes(std::uint64_t block) const override {
    return capture_.view(block).payload().size();
  }

  std::atomic<std::uint64_t> groups_unpacked = 0, groups_left_out = 0;

 private:
  BlockLease lend(std::uint64_t block, const LeaseTerms& terms) override {
    const BlockView view = capture_.view(block);
    const std::uint64_t bytes = view.payload().size();
    auto own = std::make_shared<PageBuffer>();
    std::span<std::byte> room;
    if (terms.room) {
      room = terms.room(bytes);
      if (room.empty()) return {};
    } else {
      *own = PageBuffer(bytes);
      room = own->first(bytes);
    }
    room = room.first(bytes);
    std::ranges::copy(view.payload(), room.begin());
    const std::uint64_t tiles = view.geometry().tile_count;
    for (std::uint64_t first = 0; first < tiles; first += group_tiles_) {
      const std::uint64_t last = std::min(first + group_tiles_, tiles);
      if (!terms.wants || terms.wants(first, last)) {
        ++groups_unpacked;
        continue;
      }
      ++groups_left_out;
      for (std::uint64_t tile = first; tile < last; ++tile) {
        const auto body = view.body(tile);
        std::fill_n(room.begin() + (body.data() - view.payload().data()), body.size(), std::byte{0xEE});
      }
    }
    return {view.extent(), room, std::move(own)};
  }

  MemoryCapture& capture_;
  std::uint64_t group_tiles_;
};

}  // namespace nutik::test
