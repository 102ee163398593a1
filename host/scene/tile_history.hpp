// What the pixels of a tile held, over all blocks of a capture.
#pragma once

#include <algorithm>
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

  // `starts_ns` tells when each sample begins, and last when the capture ends; samples that are not looked at take no
  // time. `blocks` are all of the capture's, in time order. Both must outlive this.
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
    // Channel by channel, in arrays that nothing else points into: so it is done in vectors.
    const auto take = [&](const std::byte* from) {
      const auto* const codes = reinterpret_cast<const Code*>(from);
      for (std::size_t first = 0; first < value_count(); first += kTilePixels) {
        Code* __restrict const low = least.data() + first;
        Code* __restrict const high = most.data() + first;
        const Code* __restrict const row = codes + first;
        for (std::size_t lane = 0; lane < kTilePixels; ++lane) {
          low[lane] = std::min(low[lane], row[lane]);
          high[lane] = std::max(high[lane], row[lane]);
        }
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
    channels() == 1 ? read_rows<1>(lane, held) : read_rows<3>(lane, held);
    for_each_record(lane, [&](const ChangeRecord& record, std::int64_t held_ns) {
      held.push_back({record.codes, static_cast<std::uint64_t>(held_ns)});
    });
  }

 private:
  struct Row {
    const std::byte* codes;
    std::int64_t held_ns;
  };

  // What a lane's rows held. Codes are compared in registers and written where they stay: read again as a whole right
  // after they were written one by one, processors would wait for them.
  template <std::size_t kChannels>
  void read_rows(std::uint32_t lane, std::vector<HeldCodes>& held) const {
    held.resize(rows_.size());
    HeldCodes* to = held.data();
    std::array<std::uint16_t, 3> last{};
    for (const Row& row : rows_) {
      const auto* const codes = reinterpret_cast<const Code*>(row.codes) + lane;
      std::array<std::uint16_t, 3> now{};
      for (std::size_t channel = 0; channel < kChannels; ++channel)
        now[channel] = codes[channel * kTilePixels];
      const auto held_ns = static_cast<std::uint64_t>(row.held_ns);
      if (to != held.data() && now[0] == last[0] && now[1] == last[1] && now[2] == last[2]) {
        to[-1].duration_ns += held_ns;
        continue;
      }
      for (std::size_t channel = 0; channel < 3; ++channel) to->codes[channel] = last[channel] = now[channel];
      to->duration_ns = held_ns;
      ++to;
    }
    held.resize(static_cast<std::size_t>(to - held.data()));
  }

  [[nodiscard]] std::uint32_t channels() const { return blocks_.front().geometry().channels; }
  [[nodiscard]] std::size_t value_count() const { return std::size_t{channels()} * kTilePixels; }

  void add_rows(const BlockView& block) {
    block.for_each_row(tile_, [&](std::uint32_t first, std::uint32_t until, const std::byte* codes) {
      const std::uint64_t sample = block.extent().first_sample;
      const std::int64_t held_ns = starts_ns_[sample + until] - starts_ns_[sample + first];
      if (held_ns > 0) rows_.push_back({codes, held_ns});
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
        const std::int64_t held_ns = starts_ns_[sample + until] - starts_ns_[sample + records_[i].sample];
        if (held_ns > 0) visit(records_[i], held_ns);
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
