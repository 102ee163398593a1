#include "tik/prediction.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <type_traits>

namespace nutik::tik {
namespace {

enum Mode : std::uint8_t { kFromRowBefore = 0, kFromNeighbours = 1 };

// Median prediction is decoded pixel by pixel, the other mode a vector at a time: it has to save at
// least a quarter of the residual to be chosen.
constexpr int kNeighbourPenaltyNum = 5;
constexpr int kNeighbourPenaltyDen = 4;

// The rows of a body: codes of a rows tile; start and slots of a records tile.
struct RowLayout {
  std::uint32_t rows;
  std::uint64_t index_bytes;  // of the list before the rows of a rows tile
  std::uint64_t index_count;  // entries of the tile's index
};

RowLayout layout_of(const TileEntry& entry, const BlockGeometry& geometry) {
  if (entry.is_records()) {
    return {entry.slots() + 1, 0, std::uint64_t{entry.slots()} * kTilePixels};
  }
  const std::uint64_t list = geometry.row_index_bytes(entry.rows());
  return {entry.rows(), list, list == 0 ? 0u : entry.rows()};
}

// Offset of a slot within a records tile's body.
std::uint64_t slot_offset(const BlockGeometry& geometry, std::uint32_t slot) {
  return geometry.row_bytes() + slot * geometry.slot_bytes();
}

// Offset of row r within a body. In records tiles slots follow the start, each with its index first.
std::uint64_t row_offset(const TileEntry& entry, const BlockGeometry& geometry, std::uint32_t row) {
  if (!entry.is_records()) return geometry.row_index_bytes(entry.rows()) + row * geometry.row_bytes();
  if (row == 0) return 0;
  return slot_offset(geometry, row - 1) + kTilePixels * geometry.index_bytes();
}

// Where the parts of a plain stream start.
struct PlainLayout {
  std::uint64_t indices = 0;
  std::uint64_t modes = 0;
  std::uint64_t residuals = 0;
  std::uint64_t rows = 0;
  std::uint64_t bytes = 0;

  explicit PlainLayout(const TileGroup& group) {
    std::uint64_t index_count = 0;
    for (const TileEntry& entry : group.entries) {
      const RowLayout layout = layout_of(entry, group.geometry);
      index_count += layout.index_count;
      rows += layout.rows;
    }
    modes = index_count * group.geometry.index_bytes();
    residuals = modes + rows;
    bytes = residuals + rows * group.geometry.row_bytes();
  }
};

template <typename Code>
constexpr Code kHalf = static_cast<Code>(1u << (8 * sizeof(Code) - 1));

template <typename Code>
Code fold(Code difference) {
  const auto sign = static_cast<std::make_signed_t<Code>>(difference);
  return static_cast<Code>((difference << 1) ^ (sign < 0 ? static_cast<Code>(~Code{0}) : Code{0}));
}
template <typename Code>
Code unfold(Code folded) {
  return static_cast<Code>((folded >> 1) ^ (folded & 1 ? static_cast<Code>(~Code{0}) : Code{0}));
}

template <typename Code>
Code median(Code left, Code above, Code corner) {
  const Code low = std::min(left, above);
  const Code high = std::max(left, above);
  if (corner >= high) return low;
  if (corner <= low) return high;
  return static_cast<Code>(left + above - corner);
}

template <typename Code, std::uint32_t Channels>
class Predictor {
 public:
  explicit Predictor(const TileGroup& group) : group_(group), layout_(group) {}

  void predict(const std::byte* payload, std::byte* plain) {
    std::byte* index_to = plain;
    std::byte* mode_to = plain + layout_.modes;
    std::uint64_t row_number = 0;
    for (const TileEntry& entry : group_.entries) {
      const RowLayout layout = layout_of(entry, group_.geometry);
      const std::byte* body = payload + entry.offset * kBlockAlignment;
      if (group_.geometry.index_bytes() == 1) {
        index_to = write_index<std::uint8_t>(entry, body, index_to);
      } else {
        index_to = write_index<std::uint16_t>(entry, body, index_to);
      }
      Planes before{};
      for (std::uint32_t row = 0; row < layout.rows; ++row) {
        Planes now;
        std::memcpy(now.data(), body + row_offset(entry, group_.geometry, row), sizeof now);
        decorrelate(now);
        Planes from_before, from_neighbours;
        for (std::size_t i = 0; i < now.size(); ++i) {
          from_before[i] = static_cast<Code>(now[i] - before[i]);
        }
        const bool first = row == 0;
        Mode mode = kFromNeighbours;
        for (std::uint32_t c = 0; c < Channels; ++c) {
          neighbour_residuals(now.data() + c * kTilePixels, before[c * kTilePixels],
                              from_neighbours.data() + c * kTilePixels);
        }
        if (!first && magnitude(from_before) * kNeighbourPenaltyDen <=
                          magnitude(from_neighbours) * kNeighbourPenaltyNum) {
          mode = kFromRowBefore;
        }
        *mode_to++ = static_cast<std::byte>(mode);
        write_residuals(mode == kFromRowBefore ? from_before : from_neighbours, row_number++, plain);
        before = now;
      }
    }
  }

  bool reconstruct(const std::byte* plain, std::byte* payload) {
    const std::byte* index_from = plain;
    const std::byte* mode_from = plain + layout_.modes;
    std::uint64_t row_number = 0;
    for (const TileEntry& entry : group_.entries) {
      const RowLayout layout = layout_of(entry, group_.geometry);
      std::byte* body = payload + entry.offset * kBlockAlignment;
      if (group_.geometry.index_bytes() == 1) {
        index_from = read_index<std::uint8_t>(entry, index_from, body);
      } else {
        index_from = read_index<std::uint16_t>(entry, index_from, body);
      }
      Planes before{};
      for (std::uint32_t row = 0; row < layout.rows; ++row) {
        Planes now;
        read_residuals(row_number++, plain, now);
        const auto mode = static_cast<Mode>(*mode_from++);
        if (mode == kFromRowBefore) {
          for (std::size_t i = 0; i < now.size(); ++i) now[i] = static_cast<Code>(now[i] + before[i]);
        } else if (mode == kFromNeighbours) {
          for (std::uint32_t c = 0; c < Channels; ++c) {
            add_neighbours(now.data() + c * kTilePixels, before[c * kTilePixels]);
          }
        } else {
          return false;
        }
        before = now;
        correlate(now);
        std::memcpy(body + row_offset(entry, group_.geometry, row), now.data(), sizeof now);
      }
    }
    return true;
  }

 private:
  using Planes = std::array<Code, Channels * kTilePixels>;

  static void decorrelate(Planes& planes) {
    if constexpr (Channels == 3) {
      for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
        const Code green = planes[kTilePixels + lane];
        const Code red = planes[lane];
        planes[kTilePixels + lane] = static_cast<Code>(red - green + kHalf<Code>);
        planes[lane] = green;
        planes[2 * kTilePixels + lane] =
            static_cast<Code>(planes[2 * kTilePixels + lane] - green + kHalf<Code>);
      }
    }
  }

  static void correlate(Planes& planes) {
    if constexpr (Channels == 3) {
      for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
        const Code green = planes[lane];
        planes[lane] = static_cast<Code>(planes[kTilePixels + lane] + green - kHalf<Code>);
        planes[kTilePixels + lane] = green;
        planes[2 * kTilePixels + lane] =
            static_cast<Code>(planes[2 * kTilePixels + lane] + green - kHalf<Code>);
      }
    }
  }

  static void neighbour_residuals(const Code* plane, Code before, Code* residuals) {
    for (std::uint32_t y = 0; y < kTileSide; ++y) {
      for (std::uint32_t x = 0; x < kTileSide; ++x) {
        residuals[y * kTileSide + x] =
            static_cast<Code>(plane[y * kTileSide + x] - neighbour_guess(plane, before, x, y));
      }
    }
  }

  static void add_neighbours(Code* plane, Code before) {
    for (std::uint32_t y = 0; y < kTileSide; ++y) {
      for (std::uint32_t x = 0; x < kTileSide; ++x) {
        Code& code = plane[y * kTileSide + x];
        code = static_cast<Code>(code + neighbour_guess(plane, before, x, y));
      }
    }
  }

  static Code neighbour_guess(const Code* plane, Code before, std::uint32_t x, std::uint32_t y) {
    const Code* at = plane + y * kTileSide + x;
    if (y == 0) return x == 0 ? before : at[-1];
    if (x == 0) return at[-static_cast<int>(kTileSide)];
    return median(at[-1], at[-static_cast<int>(kTileSide)], at[-static_cast<int>(kTileSide) - 1]);
  }

  static std::uint32_t magnitude(const Planes& residuals) {
    std::uint32_t sum = 0;
    for (const Code residual : residuals) {
      const auto value = static_cast<std::make_signed_t<Code>>(residual);
      sum += static_cast<std::uint32_t>(value < 0 ? -value : value);
    }
    return sum;
  }

  // Where a row's residuals of one channel and byte start.
  [[nodiscard]] std::uint64_t residual_offset(std::uint64_t row, std::uint32_t channel,
                                              std::uint32_t byte) const {
    return layout_.residuals +
           ((channel * sizeof(Code) + byte) * layout_.rows + row) * kTilePixels;
  }

  void write_residuals(const Planes& residuals, std::uint64_t row, std::byte* plain) const {
    for (std::uint32_t channel = 0; channel < Channels; ++channel) {
      const Code* from = residuals.data() + channel * kTilePixels;
      if constexpr (sizeof(Code) == 1) {
        std::memcpy(plain + residual_offset(row, channel, 0), from, kTilePixels);
      } else {
        std::byte* low = plain + residual_offset(row, channel, 0);
        std::byte* high = plain + residual_offset(row, channel, 1);
        for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
          const Code folded = fold(from[lane]);
          low[lane] = static_cast<std::byte>(folded & 0xFF);
          high[lane] = static_cast<std::byte>(folded >> 8);
        }
      }
    }
  }

  void read_residuals(std::uint64_t row, const std::byte* plain, Planes& residuals) const {
    for (std::uint32_t channel = 0; channel < Channels; ++channel) {
      Code* to = residuals.data() + channel * kTilePixels;
      if constexpr (sizeof(Code) == 1) {
        std::memcpy(to, plain + residual_offset(row, channel, 0), kTilePixels);
      } else {
        const std::byte* low = plain + residual_offset(row, channel, 0);
        const std::byte* high = plain + residual_offset(row, channel, 1);
        for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
          to[lane] = unfold(static_cast<Code>(static_cast<unsigned>(low[lane]) |
                                              static_cast<unsigned>(high[lane]) << 8));
        }
      }
    }
  }

  // The start of each run of 64 (or 1) index entries that follow each other.
  template <typename Index, typename Visit>
  void for_each_index_row(const TileEntry& entry, Visit visit) const {
    const RowLayout layout = layout_of(entry, group_.geometry);
    if (layout.index_count == 0) return;
    if (entry.is_records()) {
      for (std::uint32_t slot = 0; slot < entry.slots(); ++slot) {
        visit(slot_offset(group_.geometry, slot), kTilePixels);
      }
      return;
    }
    for (std::uint32_t row = 0; row < entry.rows(); ++row) visit(row * sizeof(Index), 1u);
  }

  template <typename Index>
  std::byte* write_index(const TileEntry& entry, const std::byte* body, std::byte* to) const {
    std::array<Index, kTilePixels> before{};
    for_each_index_row<Index>(entry, [&](std::uint64_t offset, std::uint32_t count) {
      std::array<Index, kTilePixels> now;
      std::memcpy(now.data(), body + offset, count * sizeof(Index));
      for (std::uint32_t i = 0; i < count; ++i) {
        const auto difference = static_cast<Index>(now[i] - before[i]);
        std::memcpy(to, &difference, sizeof difference);
        to += sizeof difference;
      }
      before = now;
    });
    return to;
  }

  template <typename Index>
  const std::byte* read_index(const TileEntry& entry, const std::byte* from, std::byte* body) const {
    std::memset(body, 0, layout_of(entry, group_.geometry).index_bytes);  // padding behind a list
    std::array<Index, kTilePixels> before{};
    for_each_index_row<Index>(entry, [&](std::uint64_t offset, std::uint32_t count) {
      for (std::uint32_t i = 0; i < count; ++i) {
        Index difference;
        std::memcpy(&difference, from, sizeof difference);
        from += sizeof difference;
        before[i] = static_cast<Index>(before[i] + difference);
      }
      std::memcpy(body + offset, before.data(), count * sizeof(Index));
    });
    return from;
  }

  const TileGroup& group_;
  PlainLayout layout_;
};

// Calls use(Predictor<Code, Channels>) for the group's kind of codes.
template <typename Use>
auto with_predictor(const TileGroup& group, Use use) {
  const bool colour = group.geometry.channels == 3;
  if (group.geometry.code_bytes == 1) {
    return colour ? use(Predictor<std::uint8_t, 3>(group)) : use(Predictor<std::uint8_t, 1>(group));
  }
  return colour ? use(Predictor<std::uint16_t, 3>(group)) : use(Predictor<std::uint16_t, 1>(group));
}

}  // namespace

std::uint64_t TileGroup::plain_bytes() const { return PlainLayout(*this).bytes; }

void predict(const TileGroup& group, std::span<const std::byte> payload, std::span<std::byte> plain) {
  with_predictor(group, [&](auto predictor) {
    predictor.predict(payload.data(), plain.data());
    return true;
  });
}

bool reconstruct(const TileGroup& group, std::span<const std::byte> plain, std::span<std::byte> payload) {
  return with_predictor(group,
                        [&](auto predictor) { return predictor.reconstruct(plain.data(), payload.data()); });
}

}  // namespace nutik::tik
