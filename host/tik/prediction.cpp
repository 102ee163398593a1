#include "tik/prediction.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

#include "tik/residual_packing.hpp"

// Predictions are chosen in loops that are compiled for several instruction sets, of which one is taken when the
// program starts. Sanitizers are not ready when that choice is made.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define NUTIK_SIMD_CLONES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define NUTIK_SIMD_CLONES
#endif

namespace nutik::tik {
namespace {

// How a row is predicted. The values stand in files.
enum class Mode : std::uint8_t {
  before,      // the row before
  neighbours,  // the median of left, above, and left + above - left above, in the same row
  drift        // the row before, plus that median of the differences from it
};
constexpr std::uint8_t kModes = 3;

// Medians are decoded pixel by pixel, `before` a vector at a time: they have to save a tenth.
constexpr std::uint32_t kMedianCost = 11;
constexpr std::uint32_t kBeforeCost = 10;

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

std::uint32_t row_count(const TileEntry& entry) {
  return entry.is_records() ? entry.slots() + 1 : entry.rows();
}

std::uint64_t index_bytes(const TileGroup& group) {
  std::uint64_t count = 0;
  for (const TileEntry& entry : group.entries) count += index_count(entry, group.geometry);
  return count * group.geometry.index_bytes();
}

std::uint64_t row_total(const TileGroup& group) {
  std::uint64_t rows = 0;
  for (const TileEntry& entry : group.entries) rows += row_count(entry);
  return rows;
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
void read_indices(const TileGroup& group, const std::byte* from, std::span<std::byte> payload) {
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

// One channel of one row.
template <typename Code>
using Plane = std::array<Code, kTilePixels>;

template <typename Code>
Code median(Code left, Code above, Code corner) {
  const Code low = std::min(left, above);
  const Code high = std::max(left, above);
  if (corner >= high) return low;
  if (corner <= low) return high;
  return static_cast<Code>(left + above - corner);
}

// What the median says of pixel (x, y) from its neighbours; `corner_guess` for the first.
template <typename Code>
Code guess(const Code* plane, std::uint32_t x, std::uint32_t y, Code corner_guess) {
  const Code* at = plane + y * kTileSide + x;
  constexpr int kAbove = kTileSide;
  if (y == 0) return x == 0 ? corner_guess : at[-1];
  if (x == 0) return at[-kAbove];
  return median(at[-1], at[-kAbove], at[-kAbove - 1]);
}

template <typename Code>
std::int16_t as_signed(Code difference) {
  return static_cast<std::make_signed_t<Code>>(difference);
}

// A value for each pixel of a tile; compilers cut these vectors into what the machine has.
using Lanes8 = std::uint8_t __attribute__((vector_size(kTilePixels)));
using Lanes16 = std::uint16_t __attribute__((vector_size(2 * kTilePixels)));
using Signed16 = std::int16_t __attribute__((vector_size(2 * kTilePixels)));
using Signed32 = std::int32_t __attribute__((vector_size(4 * kTilePixels)));

// -1 for the pixels of the first row, or of the first column.
template <typename Value>
constexpr std::array<Value, kTilePixels> first_pixels(bool of_rows) {
  std::array<Value, kTilePixels> mask{};
  for (std::size_t i = 0; i < kTileSide; ++i) mask[of_rows ? i : i * kTileSide] = -1;
  return mask;
}

// What is left of a plane beside what guess() says of it. All of it is known here, so that pixels need not wait for each
// other.
template <typename Code>
inline __attribute__((always_inline)) void subtract_medians(const Plane<Code>& plane, Code corner_guess,
                                                            Residuals& residuals) {
  using Value = std::conditional_t<sizeof(Code) == 1, std::int16_t, std::int32_t>;
  using Lanes = std::conditional_t<sizeof(Code) == 1, Lanes8, Lanes16>;
  using Wide = std::conditional_t<sizeof(Code) == 1, Signed16, Signed32>;
  static constexpr auto kFirstRow = first_pixels<Value>(true), kFirstColumn = first_pixels<Value>(false);
  // The plane behind so many codes that a pixel's neighbours lie in front of it.
  constexpr std::size_t kFront = kTileSide + 1;
  Code around[kFront + kTilePixels];
  std::fill_n(around, kFront, corner_guess);
  std::copy(plane.begin(), plane.end(), around + kFront);
  Wide neighbours[3];  // left, above, corner
  constexpr std::size_t kPlaces[] = {kFront - 1, kFront - kTileSide, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    Lanes codes;
    std::memcpy(&codes, around + kPlaces[i], sizeof codes);
    neighbours[i] = __builtin_convertvector(codes, Wide);
  }
  // Where there is one neighbour, it stands for the others: their median is what it is.
  Wide first_row, first_column;
  std::memcpy(&first_row, kFirstRow.data(), sizeof first_row);
  std::memcpy(&first_column, kFirstColumn.data(), sizeof first_column);
  const Wide edge = first_row | first_column;
  const Wide above = (neighbours[0] & first_row) | (neighbours[1] & ~first_row);
  const Wide left = (above & first_column) | (neighbours[0] & ~first_column);
  const Wide corner = (above & edge) | (neighbours[2] & ~edge);
  const Wide low = left < above ? left : above, high = left < above ? above : left;
  Wide median = left + above - corner;
  median = median < low ? low : median;
  median = median > high ? high : median;
  Lanes codes;
  std::memcpy(&codes, plane.data(), sizeof codes);
  codes -= __builtin_convertvector(median, Lanes);
  if constexpr (sizeof(Code) == 1) {
    using Signed8 = std::int8_t __attribute__((vector_size(kTilePixels)));
    const Signed16 wide = __builtin_convertvector(reinterpret_cast<Signed8>(codes), Signed16);
    std::memcpy(residuals.data(), &wide, sizeof wide);
  } else {
    std::memcpy(residuals.data(), &codes, sizeof codes);
  }
}

inline __attribute__((always_inline)) std::uint32_t magnitude(const Residuals& residuals) {
  std::uint32_t sum = 0;
  for (const std::int16_t residual : residuals) {
    sum += static_cast<std::uint32_t>(residual < 0 ? -residual : residual);
  }
  return sum;
}

template <typename Code>
inline __attribute__((always_inline)) Mode choose_mode(const Plane<Code>& now, const Plane<Code>& before,
                                                       bool is_first, Residuals& chosen) {
  // Differences are taken around the middle of the range, so that small ones of either sign are
  // neighbours for the median.
  constexpr Code kHalf = static_cast<Code>(1u << (8 * sizeof(Code) - 1));
  subtract_medians(now, before[0], chosen);
  if (is_first) return Mode::neighbours;  // there is nothing before
  Mode best = Mode::neighbours;
  std::uint32_t least = magnitude(chosen) * kMedianCost;
  Plane<Code> drift;
  Residuals residuals;
  for (std::size_t i = 0; i < kTilePixels; ++i) {
    drift[i] = static_cast<Code>(now[i] - before[i] + kHalf);
    residuals[i] = as_signed(static_cast<Code>(now[i] - before[i]));
  }
  if (const std::uint32_t sum = magnitude(residuals) * kBeforeCost; sum <= least) {
    least = sum;
    best = Mode::before;
    chosen = residuals;
  }
  subtract_medians(drift, kHalf, residuals);
  if (magnitude(residuals) * kMedianCost < least) {
    best = Mode::drift;
    chosen = residuals;
  }
  return best;
}

NUTIK_SIMD_CLONES Mode choose(const Plane<std::uint8_t>& now, const Plane<std::uint8_t>& before,
                              bool is_first, Residuals& chosen) {
  return choose_mode(now, before, is_first, chosen);
}
NUTIK_SIMD_CLONES Mode choose(const Plane<std::uint16_t>& now, const Plane<std::uint16_t>& before,
                              bool is_first, Residuals& chosen) {
  return choose_mode(now, before, is_first, chosen);
}

template <typename Code>
void add_residuals(Mode mode, const Residuals& residuals, const Plane<Code>& before, Plane<Code>& now) {
  constexpr Code kHalf = static_cast<Code>(1u << (8 * sizeof(Code) - 1));
  if (mode == Mode::before) {
    for (std::size_t i = 0; i < kTilePixels; ++i) now[i] = static_cast<Code>(before[i] + residuals[i]);
    return;
  }
  const Code first = mode == Mode::drift ? kHalf : before[0];
  for (std::uint32_t y = 0; y < kTileSide; ++y) {
    for (std::uint32_t x = 0; x < kTileSide; ++x) {
      const std::size_t i = y * kTileSide + x;
      now[i] = static_cast<Code>(guess(now.data(), x, y, first) + residuals[i]);
    }
  }
  if (mode == Mode::drift) {
    for (std::size_t i = 0; i < kTilePixels; ++i) now[i] = static_cast<Code>(now[i] + before[i] - kHalf);
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
          const Mode mode = choose(now[c], before[c], r == 0, residuals);
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
      read_indices<std::uint8_t>(group, plain.head.data(), payload);
    } else {
      read_indices<std::uint16_t>(group, plain.head.data(), payload);
    }
    const std::byte* marks = plain.head.data() + index_bytes(group);
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

std::uint64_t TileGroup::head_bytes() const {
  return index_bytes(*this) + row_total(*this) * geometry.channels;
}

PlainGroup predict(const TileGroup& group, std::span<const std::byte> payload) {
  return with_predictor(group.geometry, [&](auto predictor) { return predictor.predict(group, payload); });
}

std::optional<std::array<std::uint64_t, kPlainParts>> part_bytes(const TileGroup& group,
                                                                 std::span<const std::byte> head) {
  std::array<std::uint64_t, kPlainParts> bytes{};
  std::uint32_t channel = 0;
  for (const std::byte mark : head.subspan(index_bytes(group))) {
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
