#include "tik/prediction.hpp"

#include <array>
#include <cstring>

#include "tik/residual_packing.hpp"
#include "tik/row_prediction.hpp"

namespace nutik::tik {
namespace {

std::byte mark_of(Mode mode, Reach reach) {
  return static_cast<std::byte>(static_cast<unsigned>(reach) * kModes + static_cast<unsigned>(mode));
}
Mode mode_of_mark(std::byte mark) { return static_cast<Mode>(static_cast<unsigned>(mark) % kModes); }
Reach reach_of_mark(std::byte mark) { return static_cast<Reach>(static_cast<unsigned>(mark) / kModes); }

std::size_t part_of(std::uint32_t channel, Reach reach) {
  return channel * kReaches + static_cast<std::size_t>(reach);
}

// Entries of a tile's index: for a rows tile its rows, for a records tile 64 a slot.
std::uint64_t index_count(const TileEntry& entry, const BlockGeometry& geometry) {
  if (entry.is_records()) return std::uint64_t{entry.slots()} * kTilePixels;
  return geometry.row_index_bytes(entry.rows()) == 0 ? 0 : entry.rows();
}

std::uint64_t all_index_bytes(const TileGroup& group) {
  std::uint64_t count = 0;
  for (const TileEntry& entry : group.entries) count += index_count(entry, group.geometry);
  return count * group.geometry.index_bytes();
}

std::uint64_t row_total(const TileGroup& group) {
  std::uint64_t rows = 0;
  for (const TileEntry& entry : group.entries) rows += row_count(entry);
  return rows;
}

// Calls visit(offset in the body, entries) for each run of index entries that are kept side by side.
template <typename Index, typename Visit>
void for_each_index_run(const TileEntry& entry, const BlockGeometry& geometry, Visit visit) {
  if (entry.is_records()) {
    for (std::uint32_t slot = 0; slot < entry.slots(); ++slot)
      visit(slot_offset(geometry, slot), kTilePixels);
  } else if (index_count(entry, geometry) != 0) {
    for (std::uint32_t row = 0; row < entry.rows(); ++row) visit(row * sizeof(Index), 1u);
  }
}

template <typename Index>
void write_indices(const TileGroup& group, std::span<const std::byte> payload,
                   std::vector<std::byte>& plain) {
  for (const TileEntry& entry : group.entries) {
    const std::byte* body = payload.data() + entry.offset * kBlockAlignment;
    std::array<Index, kTilePixels> before{};
    for_each_index_run<Index>(entry, group.geometry, [&](std::uint64_t offset, std::uint32_t count) {
      std::array<Index, kTilePixels> now{};
      std::memcpy(now.data(), body + offset, count * sizeof(Index));
      for (std::uint32_t i = 0; i < count; ++i) {
        const auto difference = static_cast<Index>(now[i] - before[i]);
        const auto* bytes = reinterpret_cast<const std::byte*>(&difference);
        plain.insert(plain.end(), bytes, bytes + sizeof difference);
      }
      before = now;
    });
  }
}

template <typename Index>
void read_all_indices(const TileGroup& group, const std::byte* from, std::span<std::byte> payload) {
  for (const TileEntry& entry : group.entries) {
    std::byte* body = payload.data() + entry.offset * kBlockAlignment;
    // Padding behind a rows tile's list.
    if (!entry.is_records()) std::memset(body, 0, group.geometry.row_index_bytes(entry.rows()));
    std::array<Index, kTilePixels> now{};
    for_each_index_run<Index>(entry, group.geometry, [&](std::uint64_t offset, std::uint32_t count) {
      for (std::uint32_t i = 0; i < count; ++i) {
        Index difference;
        std::memcpy(&difference, from, sizeof difference);
        from += sizeof difference;
        now[i] = static_cast<Index>(now[i] + difference);
      }
      std::memcpy(body + offset, now.data(), count * sizeof(Index));
    });
  }
}

template <typename Code, std::uint32_t Channels>
class Predictor {
 public:
  using Row = std::array<Plane<Code>, Channels>;

  static PlainGroup predict(const TileGroup& group, std::span<const std::byte> payload) {
    PlainGroup plain;
    if (group.geometry.index_bytes() == 1) {
      write_indices<std::uint8_t>(group, payload, plain.head);
    } else {
      write_indices<std::uint16_t>(group, payload, plain.head);
    }
    for (const TileEntry& entry : group.entries) {
      const std::byte* body = payload.data() + entry.offset * kBlockAlignment;
      Row before{};
      for (std::uint32_t r = 0; r < row_count(entry); ++r) {
        Row now;
        std::memcpy(now.data(), body + row_offset(entry, group.geometry, r), sizeof now);
        decorrelate(now);
        for (std::uint32_t c = 0; c < Channels; ++c) {
          Residuals residuals;
          const Mode mode = choose_mode(now[c], before[c], r == 0, residuals);
          const Reach reach = reach_of(residuals);
          plain.head.push_back(mark_of(mode, reach));
          std::vector<std::byte>& part = plain.parts[part_of(c, reach)];
          const std::size_t bytes = kPackedBytes[static_cast<std::size_t>(reach)];
          part.resize(part.size() + bytes);
          pack_residuals(residuals, reach, part.data() + part.size() - bytes);
        }
        before = now;
      }
    }
    return plain;
  }

  static void reconstruct(const TileGroup& group, const PlainGroup& plain, std::span<std::byte> payload) {
    if (group.geometry.index_bytes() == 1) {
      read_all_indices<std::uint8_t>(group, plain.head.data(), payload);
    } else {
      read_all_indices<std::uint16_t>(group, plain.head.data(), payload);
    }
    const std::byte* marks = plain.head.data() + all_index_bytes(group);
    std::array<const std::byte*, kPlainParts> from;
    for (std::size_t part = 0; part < kPlainParts; ++part) from[part] = plain.parts[part].data();
    for (const TileEntry& entry : group.entries) {
      std::byte* body = payload.data() + entry.offset * kBlockAlignment;
      Row before{};
      for (std::uint32_t r = 0; r < row_count(entry); ++r) {
        Row now;
        for (std::uint32_t c = 0; c < Channels; ++c) {
          const std::byte mark = *marks++;
          const Reach reach = reach_of_mark(mark);
          Residuals residuals;
          unpack_residuals(from[part_of(c, reach)], reach, residuals);
          from[part_of(c, reach)] += kPackedBytes[static_cast<std::size_t>(reach)];
          add_residuals(mode_of_mark(mark), residuals, before[c], now[c]);
        }
        before = now;
        correlate(now);
        std::memcpy(body + row_offset(entry, group.geometry, r), now.data(), sizeof now);
      }
    }
  }

 private:
  static constexpr Code kHalf = static_cast<Code>(1u << (8 * sizeof(Code) - 1));

  // red green blue → green, red - green, blue - green
  static void decorrelate(Row& row) {
    if constexpr (Channels == 3) {
      for (std::size_t i = 0; i < kTilePixels; ++i) {
        const Code red = row[0][i], green = row[1][i], blue = row[2][i];
        row[0][i] = green;
        row[1][i] = static_cast<Code>(red - green + kHalf);
        row[2][i] = static_cast<Code>(blue - green + kHalf);
      }
    }
  }

  static void correlate(Row& row) {
    if constexpr (Channels == 3) {
      for (std::size_t i = 0; i < kTilePixels; ++i) {
        const Code green = row[0][i];
        row[0][i] = static_cast<Code>(row[1][i] + green - kHalf);
        row[1][i] = green;
        row[2][i] = static_cast<Code>(row[2][i] + green - kHalf);
      }
    }
  }
};

// Calls use() with the predictor for a group's kind of codes.
template <typename Use>
auto with_predictor(const BlockGeometry& geometry, Use use) {
  const bool colour = geometry.channels == 3;
  if (geometry.code_bytes == 1) {
    return colour ? use(Predictor<std::uint8_t, 3>()) : use(Predictor<std::uint8_t, 1>());
  }
  return colour ? use(Predictor<std::uint16_t, 3>()) : use(Predictor<std::uint16_t, 1>());
}

}  // namespace

std::uint64_t head_bytes(const TileGroup& group) {
  return all_index_bytes(group) + row_total(group) * group.geometry.channels;
}

PlainGroup predict(const TileGroup& group, std::span<const std::byte> payload) {
  return with_predictor(group.geometry, [&](auto predictor) { return predictor.predict(group, payload); });
}

std::optional<std::array<std::uint64_t, kPlainParts>> part_bytes(const TileGroup& group,
                                                                 std::span<const std::byte> head) {
  std::array<std::uint64_t, kPlainParts> bytes{};
  std::uint32_t channel = 0;
  for (const std::byte mark : head.subspan(all_index_bytes(group))) {
    if (static_cast<std::size_t>(mark) >= kModes * kReaches) return std::nullopt;
    const Reach reach = reach_of_mark(mark);
    bytes[part_of(channel, reach)] += kPackedBytes[static_cast<std::size_t>(reach)];
    channel = (channel + 1) % group.geometry.channels;
  }
  return bytes;
}

void reconstruct(const TileGroup& group, const PlainGroup& plain, std::span<std::byte> payload) {
  with_predictor(group.geometry, [&](auto predictor) { predictor.reconstruct(group, plain, payload); });
}

}  // namespace nutik::tik
