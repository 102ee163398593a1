// What the pixels of a tile held, over all blocks of a capture.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "imev/block.hpp"

namespace nutik {

// The codes of a pixel, and for how long it held them.
struct HeldCodes {
  std::array<std::uint16_t, 3> codes{};
  std::uint64_t duration_ns = 0;
};

template <typename Code>
class TileHistory {
 public:
  using Codes = std::array<Code, 3 * kTilePixels>;  // [channel][lane]
  using Light = std::array<double, 3 * kTilePixels>;

  // Samples begin at `starts_ns`, which end with the end of the capture; blocks are all of the capture's, in time order.
  // What is handed over must outlive this.
  TileHistory(const std::vector<BlockView>& blocks, std::span<const std::int64_t> starts_ns)
      : blocks_(blocks), starts_ns_(starts_ns) {}

  void read(std::uint64_t tile) {
    tile_ = tile;
    rows_.clear();
    recorded_.clear();
    for (const BlockView& block : blocks_) {
      if (block.entry(tile).is_records()) {
        recorded_.push_back(&block);
      } else {
        add_rows(block);
      }
    }
  }

  // The least and the largest codes of each lane.
  void find_span(Codes& least, Codes& most) const {
    least.fill(static_cast<Code>(~Code{0}));
    most.fill(0);
    const auto take = [&](const std::byte* from) {
      const auto* const codes = reinterpret_cast<const Code*>(from);
      for (std::size_t i = 0; i < value_count(); ++i) {
        least[i] = codes[i] < least[i] ? codes[i] : least[i];
        most[i] = codes[i] > most[i] ? codes[i] : most[i];
      }
    };
    for (const Row& row : rows_) take(row.codes);
    for (const BlockView* block : recorded_) {
      const BlockGeometry& geometry = block->geometry();
      const std::byte* slot = block->body(tile_).data();
      take(slot);
      slot += geometry.row_bytes();
      for (std::uint32_t i = 0; i < block->entry(tile_).slots(); ++i, slot += geometry.slot_bytes()) {
        take(slot + std::size_t{kTilePixels} * geometry.index_bytes());
      }
    }
  }

  // The sums of each lane's light over the time, by codes.
  void add_light(std::span<const double> light_of_code, Light& sums) {
    for (const Row& row : rows_) {
      const auto* const codes = reinterpret_cast<const Code*>(row.codes);
      const auto held_ns = static_cast<double>(row.held_ns);
      for (std::size_t i = 0; i < value_count(); ++i) sums[i] += light_of_code[codes[i]] * held_ns;
    }
    if (recorded_.empty()) return;
    for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
      for_each_record(lane, [&](const ChangeRecord& record, std::int64_t held_ns) {
        for (std::uint32_t channel = 0; channel < channels(); ++channel) {
          sums[channel * kTilePixels + lane] +=
              light_of_code[record.codes[channel]] * static_cast<double>(held_ns);
        }
      });
    }
  }

  // What a lane held, one after another where all blocks have rows.
  void read_lane(std::uint32_t lane, std::vector<HeldCodes>& held) {
    held.clear();
    for (const Row& row : rows_) {
      const auto* const codes = reinterpret_cast<const Code*>(row.codes);
      HeldCodes now;
      for (std::uint32_t channel = 0; channel < channels(); ++channel) {
        now.codes[channel] = codes[channel * kTilePixels + lane];
      }
      if (held.empty() || !is_same(held.back(), now)) held.push_back(now);
      held.back().duration_ns += static_cast<std::uint64_t>(row.held_ns);
    }
    for_each_record(lane, [&](const ChangeRecord& record, std::int64_t held_ns) {
      held.push_back({record.codes, static_cast<std::uint64_t>(held_ns)});
    });
  }

 private:
  struct Row {
    const std::byte* codes;
    std::int64_t held_ns;
  };

  // Arrays are compared by a call, which takes longer than all else here.
  [[nodiscard]] static bool is_same(const HeldCodes& a, const HeldCodes& b) {
    return a.codes[0] == b.codes[0] && a.codes[1] == b.codes[1] && a.codes[2] == b.codes[2];
  }

  [[nodiscard]] std::uint32_t channels() const { return blocks_.front().geometry().channels; }
  [[nodiscard]] std::size_t value_count() const { return std::size_t{channels()} * kTilePixels; }

  void add_rows(const BlockView& block) {
    block.for_each_row(tile_, [&](std::uint32_t first, std::uint32_t until, const std::byte* codes) {
      const std::uint64_t sample = block.extent().first_sample;
      rows_.push_back({codes, starts_ns_[sample + until] - starts_ns_[sample + first]});
    });
  }

  template <typename Visit>
  void for_each_record(std::uint32_t lane, Visit visit) {
    for (const BlockView* block : recorded_) {
      block->read_history(tile_, lane, records_);
      const std::uint64_t sample = block->extent().first_sample;
      for (std::size_t i = 0; i < records_.size(); ++i) {
        const std::uint32_t until =
            i + 1 < records_.size() ? records_[i + 1].sample : block->extent().sample_count;
        visit(records_[i], starts_ns_[sample + until] - starts_ns_[sample + records_[i].sample]);
      }
    }
  }

  const std::vector<BlockView>& blocks_;
  std::span<const std::int64_t> starts_ns_;
  std::uint64_t tile_ = 0;
  std::vector<Row> rows_;
  std::vector<const BlockView*>
      recorded_;  // blocks in which each of the tile's pixels has records of its own
  std::vector<ChangeRecord> records_;
};

}  // namespace nutik
