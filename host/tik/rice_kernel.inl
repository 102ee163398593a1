// The kernel of rice.hpp. rice.cpp includes it once for each set of instructions, each time in a namespace of its own,
// with
//
//   kVectorBytes    of a vector: 16 or 32
//   NUTIK_AVX2      1 where AVX2 and BMI2 are at hand, else 0
//
// Everything is whole-number arithmetic modulo the range of codes, so that both make the same bytes.

// ── Bits of 64 lanes ──

// A vector of bytes; a plane of bytes has kBytesParts of them. Small structures of vectors are passed by reference:
// they stay in registers once all of this is inlined.
using Bytes = std::uint8_t __attribute__((vector_size(kVectorBytes)));
using SignedBytes = std::int8_t __attribute__((vector_size(kVectorBytes)));
using Words = std::uint64_t __attribute__((vector_size(kVectorBytes)));
inline constexpr std::size_t kBytesParts = kTilePixels / kVectorBytes;
struct ByteLanes {
  Bytes part[kBytesParts];
};
// Structures are loaded, stored and assigned vector by vector: compilers copy them in smaller pieces, for which the
// next load of a vector has to wait.
template <typename Vectors>
NUTIK_INLINE void assign(Vectors& to, const Vectors& from) {
  for (std::size_t p = 0; p < sizeof to / kVectorBytes; ++p) to.part[p] = from.part[p];
}
template <typename Vectors>
NUTIK_INLINE void take(const void* from, Vectors& to) {
  for (std::size_t p = 0; p < sizeof to / kVectorBytes; ++p) {
    std::memcpy(&to.part[p], static_cast<const std::byte*>(from) + p * kVectorBytes, kVectorBytes);
  }
}
template <typename Vectors>
NUTIK_INLINE void give(const Vectors& from, void* to) {
  for (std::size_t p = 0; p < sizeof from / kVectorBytes; ++p) {
    std::memcpy(static_cast<std::byte*>(to) + p * kVectorBytes, &from.part[p], kVectorBytes);
  }
}

// The highest bit of each lane.
NUTIK_INLINE std::uint64_t highest_bits(const ByteLanes& lanes) {
  std::uint64_t bits = 0;
  for (std::size_t p = 0; p < kBytesParts; ++p) {
#if NUTIK_AVX2
    const auto some = static_cast<std::uint32_t>(_mm256_movemask_epi8(reinterpret_cast<const __m256i&>(lanes.part[p])));
    bits |= std::uint64_t{some} << p * kVectorBytes;
#else
    std::uint64_t words[kVectorBytes / 8];
    std::memcpy(words, &lanes.part[p], sizeof words);
    for (std::size_t w = 0; w < kVectorBytes / 8; ++w) {
      const std::uint64_t eight = (words[w] >> 7 & 0x0101'0101'0101'0101) * 0x0102'0408'1020'4080 >> 56;
      bits |= eight << (p * kVectorBytes + w * 8);
    }
#endif
  }
  return bits;
}

// All bits set in each lane whose bit is.
NUTIK_INLINE void spread_bits(std::uint64_t bits, ByteLanes& lanes) {
  for (std::size_t p = 0; p < kBytesParts; ++p) {
#if NUTIK_AVX2
    const __m256i own = _mm256_set1_epi64x(static_cast<long long>(0x8040'2010'0804'0201));
    const __m256i bytes = _mm256_setr_epi8(0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1,  //
                                           2, 2, 2, 2, 2, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3, 3);
    const __m256i four = _mm256_set1_epi32(static_cast<int>(bits >> p * kVectorBytes & 0xFFFF'FFFF));
    const __m256i picked = _mm256_and_si256(_mm256_shuffle_epi8(four, bytes), own);
    reinterpret_cast<__m256i&>(lanes.part[p]) = _mm256_cmpeq_epi8(picked, own);
#else
    std::uint64_t words[kVectorBytes / 8], own[kVectorBytes / 8];
    for (std::size_t w = 0; w < kVectorBytes / 8; ++w) {
      own[w] = 0x8040'2010'0804'0201;
      words[w] = (bits >> (p * kVectorBytes + w * 8) & 0xFF) * 0x0101'0101'0101'0101 & own[w];
    }
    Bytes picked, single;
    std::memcpy(&picked, words, sizeof picked);
    std::memcpy(&single, own, sizeof single);
    lanes.part[p] = reinterpret_cast<Bytes>(picked == single);
#endif
  }
}

// The bits of `from` at the ones of `mask`, moved together; and apart again.
NUTIK_INLINE std::uint64_t gathered(std::uint64_t from, std::uint64_t mask) {
#if NUTIK_AVX2
  return _pext_u64(from, mask);
#else
  return gathered_bits(from, mask);
#endif
}
NUTIK_INLINE std::uint64_t scattered(std::uint64_t from, std::uint64_t mask) {
#if NUTIK_AVX2
  return _pdep_u64(from, mask);
#else
  return scattered_bits(from, mask);
#endif
}

// Ones in the lines of a tile that have a one.
NUTIK_INLINE std::uint64_t lines_of(std::uint64_t lanes) {
  constexpr std::uint64_t kLow = 0x7F7F'7F7F'7F7F'7F7F;
  const std::uint64_t highest = (((lanes & kLow) + kLow) | lanes) & ~kLow;
  return (highest >> 7) * 0xFF;
}

// ── A plane: 64 codes ──

using SignedShorts = std::int16_t __attribute__((vector_size(kVectorBytes)));
using Shorts = std::uint16_t __attribute__((vector_size(kVectorBytes)));
using Longs = std::uint32_t __attribute__((vector_size(kVectorBytes)));
template <typename Code>
using Lanes = std::conditional_t<sizeof(Code) == 1, Bytes, Shorts>;
template <typename Code>
using SignedLanes = std::conditional_t<sizeof(Code) == 1, SignedBytes, SignedShorts>;
template <typename Code>
inline constexpr std::size_t kParts = kTilePixels * sizeof(Code) / kVectorBytes;

template <typename Code>
struct CodeLanes {
  Lanes<Code> part[kParts<Code>];
};

// Without the lowest bits that no code has.
template <typename Code>
NUTIK_INLINE void load(const std::byte* from, std::uint32_t shift, CodeLanes<Code>& to) {
  take(from, to);
  if constexpr (sizeof(Code) == 2) {
    for (std::size_t p = 0; p < kParts<Code>; ++p) to.part[p] >>= static_cast<Code>(shift);
  }
}
template <typename Code>
NUTIK_INLINE void store(const CodeLanes<Code>& from, std::uint32_t shift, std::byte* to) {
  if constexpr (sizeof(Code) == 1) {
    give(from, to);
  } else {
    CodeLanes<Code> codes;
    for (std::size_t p = 0; p < kParts<Code>; ++p) codes.part[p] = from.part[p] << static_cast<Code>(shift);
    give(codes, to);
  }
}

template <typename Code>
NUTIK_INLINE void subtract(const CodeLanes<Code>& from, const CodeLanes<Code>& what, CodeLanes<Code>& to) {
  for (std::size_t p = 0; p < kParts<Code>; ++p) to.part[p] = from.part[p] - what.part[p];
}
template <typename Code>
NUTIK_INLINE void add(const CodeLanes<Code>& to, const CodeLanes<Code>& what, CodeLanes<Code>& sum) {
  for (std::size_t p = 0; p < kParts<Code>; ++p) sum.part[p] = to.part[p] + what.part[p];
}

// 0, -1, 1, -2 … as 0, 1, 2, 3 …
template <typename Code>
NUTIK_INLINE void fold(const CodeLanes<Code>& signs, CodeLanes<Code>& folded) {
  for (std::size_t p = 0; p < kParts<Code>; ++p) {
    const Lanes<Code> negative = reinterpret_cast<Lanes<Code>>(reinterpret_cast<SignedLanes<Code>>(signs.part[p]) < 0);
    folded.part[p] = (signs.part[p] + signs.part[p]) ^ negative;
  }
}
template <typename Code>
NUTIK_INLINE void unfold(const CodeLanes<Code>& folded, CodeLanes<Code>& signs) {
  for (std::size_t p = 0; p < kParts<Code>; ++p) {
    signs.part[p] = (folded.part[p] >> 1) ^ (Lanes<Code>{} - (folded.part[p] & 1));
  }
}

template <typename Code>
NUTIK_INLINE std::uint32_t sum_of(const CodeLanes<Code>& lanes) {
  std::uint32_t sum = 0;
#if NUTIK_AVX2
  if constexpr (sizeof(Code) == 1) {
    const __m256i zero = _mm256_setzero_si256();
    const __m256i four = _mm256_add_epi64(_mm256_sad_epu8(reinterpret_cast<const __m256i&>(lanes.part[0]), zero),
                                          _mm256_sad_epu8(reinterpret_cast<const __m256i&>(lanes.part[1]), zero));
    const __m128i two = _mm_add_epi64(_mm256_castsi256_si128(four), _mm256_extracti128_si256(four, 1));
    return static_cast<std::uint32_t>(_mm_cvtsi128_si64(two) + _mm_extract_epi64(two, 1));
  }
#endif
  Longs wide{};
  for (std::size_t p = 0; p < kParts<Code>; ++p) {
    if constexpr (sizeof(Code) == 1) {
      const Shorts twos = reinterpret_cast<Shorts>(lanes.part[p]);
      const Longs pairs = reinterpret_cast<Longs>((twos & 0xFF) + (twos >> 8));
      wide += (pairs & 0xFFFF) + (pairs >> 16);
    } else {
      const Longs pairs = reinterpret_cast<Longs>(lanes.part[p]);
      wide += (pairs & 0xFFFF) + (pairs >> 16);
    }
  }
  for (std::size_t i = 0; i < kVectorBytes / 4; ++i) sum += wide[i];
  return sum;
}

// By how many steps each lane moved, as the nearest to a code that is cut off at 0 and white needs; false where any
// moved otherwise.
template <typename Code>
NUTIK_INLINE bool count_steps(const CodeLanes<Code>& now, const CodeLanes<Code>& before, const CodeSteps& steps,
                              CodeLanes<Code>& counts) {
  Code codes[kTilePixels], held[kTilePixels];
  give(now, codes);
  give(before, held);
  std::int32_t missed = 0;
  for (std::size_t l = 0; l < kTilePixels; ++l) {
    const std::int32_t count = steps.count(held[l], codes[l], 1);
    missed |= steps.moved(held[l], count) ^ codes[l];
    held[l] = static_cast<Code>(count);
  }
  take(held, counts);
  return missed == 0;
}
template <typename Code>
NUTIK_INLINE void add_steps(const CodeLanes<Code>& before, const CodeSteps& steps, CodeLanes<Code>& counts) {
  Code codes[kTilePixels], held[kTilePixels];
  give(counts, codes);
  give(before, held);
  for (std::size_t l = 0; l < kTilePixels; ++l)
    codes[l] = static_cast<Code>(steps.moved(held[l], static_cast<std::make_signed_t<Code>>(codes[l])));
  take(codes, counts);
}

// Those that lead nearest to the pixel above, in the first line to the left one; none for the first pixel. `codes` are
// known before they are asked for.
template <typename Code, typename Use>
NUTIK_INLINE void each_count_above(const Code* codes, const Code* held, const CodeSteps& steps, Use use) {
  use(0, 0);
  for (std::size_t l = 1; l < kTileSide; ++l) use(l, steps.nearest_count(held[l], codes[l - 1]));
  for (std::size_t y = kTileSide; y < kTilePixels; y += kTileSide)
    for (std::size_t l = y; l < y + kTileSide; ++l) use(l, steps.nearest_count(held[l], codes[l - kTileSide]));
}

// Any bit that is set in any lane.
template <typename Code>
NUTIK_INLINE std::uint32_t bits_in(const CodeLanes<Code>& lanes) {
  Lanes<Code> any = lanes.part[0];
  for (std::size_t p = 1; p < kParts<Code>; ++p) any |= lanes.part[p];
  const Words words = reinterpret_cast<Words>(any);
  std::uint64_t bits = 0;
  for (std::size_t w = 0; w < kVectorBytes / 8; ++w) bits |= words[w];
  bits |= bits >> 32;
  bits |= bits >> 16;
  if constexpr (sizeof(Code) == 1) bits |= bits >> 8;
  return static_cast<Code>(bits);
}

// What lies above each pixel; in the first line left of it, and `corner` for the first.
template <typename Code>
NUTIK_INLINE void above_of(const CodeLanes<Code>& plane, Code corner, CodeLanes<Code>& above) {
  // What stands for the line before the first, in the last places of a vector.
  constexpr std::size_t kLast = kVectorBytes / 8 - 1;
  const Words first = reinterpret_cast<Words>(plane.part[0]);
  Words before{};
  if constexpr (sizeof(Code) == 1) {
    before[kLast] = first[0] << 8 | corner;
  } else {
    before[kLast - 1] = first[0] << 16 | corner;
    before[kLast] = first[1] << 16 | first[0] >> 48;
  }
  for (std::size_t p = 0; p < kParts<Code>; ++p) {
    const Words now = reinterpret_cast<Words>(plane.part[p]);
    Words moved;
#if NUTIK_AVX2
    if constexpr (sizeof(Code) == 1) {
      moved = __builtin_shufflevector(before, now, 3, 4, 5, 6);
    } else {
      moved = __builtin_shufflevector(before, now, 2, 3, 4, 5);
    }
#else
    if constexpr (sizeof(Code) == 1) {
      moved = __builtin_shufflevector(before, now, 1, 2);
    } else {
      moved = before;
    }
#endif
    above.part[p] = reinterpret_cast<Lanes<Code>>(moved);
    before = now;
  }
}

using ByteLine = std::uint8_t __attribute__((vector_size(kTileSide)));
using ShortLine = std::uint16_t __attribute__((vector_size(2 * kTileSide)));

// Undoes `plane - above_of(plane)`.
template <typename Code>
NUTIK_INLINE void add_up(const CodeLanes<Code>& differences, Code corner, CodeLanes<Code>& plane) {
  using Line = std::conditional_t<sizeof(Code) == 1, ByteLine, ShortLine>;
  Code codes[kTilePixels];
  give(differences, codes);
  Line line;
  std::memcpy(&line, codes, sizeof line);
  const Line zeros{};
  line += __builtin_shufflevector(zeros, line, 0, 8, 9, 10, 11, 12, 13, 14);
  line += __builtin_shufflevector(zeros, line, 0, 1, 8, 9, 10, 11, 12, 13);
  line += __builtin_shufflevector(zeros, line, 0, 1, 2, 3, 8, 9, 10, 11);
  line += corner;
  std::memcpy(codes, &line, sizeof line);
  for (std::size_t y = 1; y < kTileSide; ++y) {
    Line difference;
    std::memcpy(&difference, codes + y * kTileSide, sizeof difference);
    line += difference;
    std::memcpy(codes + y * kTileSide, &line, sizeof line);
  }
  take(codes, plane);
}

// ── Rice codes of a plane ──

// How many low bits 64 values have of their own, so that less than 16 levels are left. One more costs 64 bits and
// halves the levels: it saves some where they add up to more than about 80, for half of the halves are cut off. What is
// left of a sum after k of them is about (sum + 48) / 2^k - 48.
template <typename Code>
NUTIK_INLINE std::uint32_t choose_low(const CodeLanes<Code>& values, std::uint32_t sum) {
  const auto width = static_cast<std::uint32_t>(std::bit_width(bits_in(values)));
  const auto worth = static_cast<std::uint32_t>(std::bit_width((sum + 48) >> 7));
  return std::max(width > kLevelBits ? width - kLevelBits : 0, worth);
}

// The bytes of all lanes, shifted to the right by `low`: levels, of which the largest is below 16.
template <typename Code>
NUTIK_INLINE void levels_of(const CodeLanes<Code>& values, std::uint32_t low, ByteLanes& levels) {
  if constexpr (sizeof(Code) == 1) {
    for (std::size_t p = 0; p < kBytesParts; ++p) levels.part[p] = values.part[p] >> static_cast<Code>(low);
  } else {
    for (std::size_t p = 0; p < kBytesParts; ++p) {
      using Half = std::uint8_t __attribute__((vector_size(kVectorBytes / 2)));
      const Half halves[2] = {
          __builtin_convertvector(values.part[2 * p] >> static_cast<Code>(low), Half),
          __builtin_convertvector(values.part[2 * p + 1] >> static_cast<Code>(low), Half)};
      std::memcpy(&levels.part[p], halves, sizeof halves);
    }
  }
}

// Writes a plane's values; returns its shape, and whether its lines are told.
template <typename Code>
NUTIK_INLINE std::pair<std::uint8_t, bool> write_plane(const CodeLanes<Code>& values, std::uint32_t low,
                                                       RiceWriter& to) {
  ByteLanes bytes;
  levels_of(values, 0, bytes);
  for (std::uint32_t bit = 0; bit < low; ++bit) {
    if (sizeof(Code) == 2 && bit == 8) levels_of(values, 8, bytes);
    ByteLanes highest;
    for (std::size_t p = 0; p < kBytesParts; ++p)
      highest.part[p] = bytes.part[p] << static_cast<std::uint8_t>(7 - bit % 8);
    to.put_plane(highest_bits(highest));
  }
  ByteLanes levels;
  levels_of(values, low, levels);
  std::uint64_t lanes = ~std::uint64_t{0};
  bool tells_lines = false;
  std::uint32_t level = 0;  // the last one that any lane reached
  for (;; ++level) {
    ByteLanes reached;
    for (std::size_t p = 0; p < kBytesParts; ++p) {
      reached.part[p] = reinterpret_cast<Bytes>(reinterpret_cast<SignedBytes>(levels.part[p]) >
                                                static_cast<std::int8_t>(level));
    }
    const std::uint64_t reach = highest_bits(reached);
    if (reach == 0) break;
    if (level == 0) {
      const std::uint64_t lines = lines_of(reach);
      if (std::popcount(lines) <= kFewLanes) {
        tells_lines = true;
        lanes = lines;
        to.put(gathered(lines, 0x0101'0101'0101'0101), kTileSide);
      }
    }
    to.put(gathered(reach, lanes), static_cast<std::uint32_t>(std::popcount(lanes)));
    lanes = reach;
  }
  return {static_cast<std::uint8_t>(low << kLevelBits | level), tells_lines};
}

template <typename Code>
NUTIK_INLINE void read_plane(std::uint8_t shape, bool tells_lines, RiceReader& from, CodeLanes<Code>& values) {
  const std::uint32_t low = shape >> kLevelBits, most = shape & kMaxLevels;
  ByteLanes levels{};
  std::uint64_t lanes = ~std::uint64_t{0};
  for (std::uint32_t level = 1; level <= most; ++level) {
    if (level == 1 && tells_lines) lanes = scattered(from.get(kTileSide), 0x0101'0101'0101'0101) * 0xFF;
    lanes = scattered(from.get(static_cast<std::uint32_t>(std::popcount(lanes))), lanes);
    ByteLanes reached;
    spread_bits(lanes, reached);
    for (std::size_t p = 0; p < kBytesParts; ++p) levels.part[p] -= reached.part[p];
  }
  ByteLanes low_bytes[2] = {};
  for (std::uint32_t bit = 0; bit < low; ++bit) {
    ByteLanes set;
    spread_bits(from.get_plane(), set);
    ByteLanes& bytes = low_bytes[sizeof(Code) == 1 ? 0 : bit / 8];
    const auto own = static_cast<std::uint8_t>(1u << bit % 8);
    for (std::size_t p = 0; p < kBytesParts; ++p) bytes.part[p] |= set.part[p] & own;
  }
  if constexpr (sizeof(Code) == 1) {
    for (std::size_t p = 0; p < kBytesParts; ++p) {
      // Where a group has wider values, a plane of bytes may tell more low bits than it has, in a file that was made
      // up.
      values.part[p] = low_bytes[0].part[p] | levels.part[p] << static_cast<Code>(std::min(low, 7u));
    }
  } else {
    for (std::size_t p = 0; p < kParts<Code>; ++p) {
      using Half = std::uint8_t __attribute__((vector_size(kVectorBytes / 2)));
      Lanes<Code> wide[3];
      const ByteLanes* const bytes[3] = {&levels, &low_bytes[0], &low_bytes[1]};
      for (std::size_t i = 0; i < 3; ++i) {
        Half half;
        std::memcpy(&half, reinterpret_cast<const std::byte*>(bytes[i]) + p * sizeof half, sizeof half);
        wide[i] = __builtin_convertvector(half, Lanes<Code>);
      }
      values.part[p] = wide[0] << static_cast<Code>(low) | wide[1] | wide[2] << 8;
    }
  }
}

// ── Tiles ──

template <typename Code, std::uint32_t Channels>
class Kernel {
 public:
  static void encode(const TileGroup& group, std::span<const std::byte> payload, RiceWriter& to) {
    Code corners[Channels] = {};
    for (const TileEntry& entry : group.entries) {
      const std::byte* const body = payload.data() + entry.offset * kBlockAlignment;
      const std::byte *before = nullptr, *before_that = nullptr;
      for (std::uint32_t r = 0; r < row_count(entry); ++r) {
        const std::byte* const now = body + row_offset(entry, group.geometry, r);
        if (entry.is_records() && r > 0) encode_index(group.geometry, body, r - 1, to);
        for (std::uint32_t i = 0; i < Channels; ++i) {
          if (before == nullptr) {
            encode_first(now, i, corners[i], to);
          } else {
            encode_next(now, before, before_that, i, to);
          }
        }
        before_that = std::exchange(before, now);
      }
    }
  }

  static void decode(const TileGroup& group, RiceReader& from, std::span<std::byte> payload) {
    Code corners[Channels] = {};
    for (const TileEntry& entry : group.entries) {
      std::byte* const body = payload.data() + entry.offset * kBlockAlignment;
      const std::byte *before = nullptr, *before_that = nullptr;
      for (std::uint32_t r = 0; r < row_count(entry); ++r) {
        std::byte* const now = body + row_offset(entry, group.geometry, r);
        if (entry.is_records() && r > 0) decode_index(group.geometry, body, r - 1, from);
        for (std::uint32_t i = 0; i < Channels; ++i) decode_row(now, before, before_that, i, corners[i], from);
        before_that = std::exchange(before, now);
      }
    }
  }

 private:
  static constexpr std::size_t kPlaneBytes = kTilePixels * sizeof(Code);
  static constexpr Code kHalf = static_cast<Code>(1u << (8 * sizeof(Code) - 1));

  // Green comes first: others may lean on it.
  static constexpr std::size_t channel_offset(std::uint32_t i) {
    return Channels == 1 ? 0 : (i == 0 ? 1 : i == 1 ? 0 : 2) * kPlaneBytes;
  }

  static void encode_first(const std::byte* now, std::uint32_t i, Code& corner, RiceWriter& to) {
    CodeLanes<Code> values;
    load(now + channel_offset(i), to.shift(), values);
    Plane<Code> plane;
    if (i > 0) {
      CodeLanes<Code> green;
      load(now + channel_offset(0), to.shift(), green);
      subtract(values, green, values);
      for (std::size_t p = 0; p < kParts<Code>; ++p) values.part[p] += kHalf;
    }
    give(values, plane.data());
    Plane<Code> around;
    around.fill(corner);
    Residuals residuals;
    static_cast<void>(choose_mode(plane, around, true, residuals));
    corner = plane[kTileSide - 1];
    Code codes[kTilePixels];
    for (std::size_t l = 0; l < kTilePixels; ++l) codes[l] = static_cast<Code>(residuals[l]);
    take(codes, values);
    fold(values, values);
    write(values, sum_of(values), RiceMode::median, i > 0, to);
  }

  struct Predicted {
    std::uint32_t sum;
    RiceMode mode;
    bool is_marked;
    CodeLanes<Code> values;
  };

  // Tries for counts of steps what is above, whole and half of the way there, and half of the way back to the row
  // before the last: where noise is all that changes, the mean of two is nearer than one.
  static void predict_steps(const CodeLanes<Code>& now, const CodeLanes<Code>& before, const CodeLanes<Code>& change,
                            const std::byte* row_before_that, std::uint32_t i, const RiceWriter& to, Predicted& best) {
    Code codes[kTilePixels], held[kTilePixels], counts[kTilePixels], tried[3][kTilePixels];
    give(now, codes);
    give(before, held);
    give(change, counts);
    each_count_above(codes, held, to.steps(), [&](std::size_t l, std::int32_t above) {
      tried[0][l] = static_cast<Code>(counts[l] - above);
      tried[1][l] = static_cast<Code>(counts[l] - above / 2);
    });
    if (row_before_that != nullptr) half_back(before, row_before_that + channel_offset(i), to.steps(), codes);
    for (std::size_t l = 0; l < kTilePixels; ++l) tried[2][l] = static_cast<Code>(counts[l] - codes[l]);
    for (std::size_t each = 0; each < (row_before_that != nullptr ? 3 : 2); ++each) {
      CodeLanes<Code> values;
      take(tried[each], values);
      fold(values, values);
      const std::uint32_t sum = sum_of(values);
      if (sum >= best.sum) continue;
      best.sum = sum;
      best.mode = each == 2 ? RiceMode::median : RiceMode::above;
      best.is_marked = each == 1;
      assign(best.values, values);
    }
  }

  // Half of the steps from a row to the one before it.
  static void half_back(const CodeLanes<Code>& before, const std::byte* before_that, const CodeSteps& steps,
                        Code* counts) {
    CodeLanes<Code> earlier, back;
    load(before_that, 0, earlier);
    static_cast<void>(count_steps(earlier, before, steps, back));
    give(back, counts);
    for (std::size_t l = 0; l < kTilePixels; ++l)
      counts[l] = static_cast<Code>(static_cast<std::make_signed_t<Code>>(counts[l]) / 2);
  }

  // Tries the row before with and without green, and the pixels above for what is better of these.
  static void encode_next(const std::byte* row, const std::byte* row_before, const std::byte* row_before_that,
                          std::uint32_t i, RiceWriter& to) {
    CodeLanes<Code> now, before, change, values;
    load(row + channel_offset(i), to.shift(), now);
    load(row_before + channel_offset(i), to.shift(), before);
    const bool in_steps = to.may_step() && count_steps(now, before, to.steps(), change);
    if (!in_steps) subtract(now, before, change);
    fold(change, values);
    std::uint32_t sum = sum_of(values);
    Predicted by_steps{sum, RiceMode::before, false, {}};
    if (in_steps && sum > kGoodEnough) predict_steps(now, before, change, row_before_that, i, to, by_steps);
    bool leans = false;
    if (i > 0 && sum > kGoodEnough) {
      CodeLanes<Code> green, green_before, green_change, leaning;
      load(row + channel_offset(0), to.shift(), green);
      load(row_before + channel_offset(0), to.shift(), green_before);
      if (in_steps) {
        static_cast<void>(count_steps(green, green_before, to.steps(), green_change));
      } else {
        subtract(green, green_before, green_change);
      }
      subtract(change, green_change, green_change);
      fold(green_change, leaning);
      const std::uint32_t leaning_sum = sum_of(leaning);
      leans = leaning_sum < sum;
      if (leans) {
        assign(values, leaning);
        assign(change, green_change);
        subtract(now, green, now);
        subtract(before, green_before, before);
        sum = leaning_sum;
      }
    }
    RiceMode mode = RiceMode::before;
    if (sum > kGoodEnough) {
      CodeLanes<Code> above, others[2];
      above_of(now, before.part[0][0], above);
      subtract(now, above, others[0]);
      fold(others[0], others[0]);
      above_of(change, Code{0}, above);
      subtract(change, above, others[1]);
      fold(others[1], others[1]);
      const std::uint32_t sums[2] = {sum_of(others[0]), sum_of(others[1])};
      const std::size_t better = sums[1] < sums[0] ? 1 : 0;
      if (sums[better] < sum) {
        mode = better == 0 ? RiceMode::above : RiceMode::drift;
        sum = sums[better];
        for (std::size_t p = 0; p < kParts<Code>; ++p) values.part[p] = others[better].part[p];
      }
    }
    if (by_steps.sum < sum) {
      write(by_steps.values, by_steps.sum, by_steps.mode, by_steps.is_marked, to, true);
    } else {
      write(values, sum, mode, leans, to, in_steps && mode != RiceMode::above);
    }
  }

  template <typename Value>
  NUTIK_INLINE static void write(const CodeLanes<Value>& values, std::uint32_t sum, RiceMode mode, bool leans,
                                 RiceWriter& to, bool in_steps = false) {
    const auto [shape, tells_lines] =
        sum == 0 ? std::pair(std::uint8_t{0}, false) : write_plane(values, choose_low(values, sum), to);
    to.put_mark(shape, static_cast<std::uint8_t>(static_cast<unsigned>(mode) | (leans ? kLeans : 0u) |
                                                 (tells_lines ? kTellsLines : 0u) | (in_steps ? kInSteps : 0u)));
  }

  static void decode_row(std::byte* row, const std::byte* row_before, const std::byte* row_before_that, std::uint32_t i,
                         Code& corner, RiceReader& from) {
    const RiceMark mark = from.get_mark();
    const auto mode = static_cast<RiceMode>(mark.how & kModeBits);
    const bool is_marked = (mark.how & kLeans) != 0, leans = i > 0 && is_marked;
    CodeLanes<Code> plane, before{}, green{}, green_before{};
    read_plane(mark.shape, (mark.how & kTellsLines) != 0, from, plane);
    unfold(plane, plane);
    if (row_before != nullptr) load(row_before + channel_offset(i), from.shift(), before);
    if (leans) {
      load(row + channel_offset(0), from.shift(), green);
      if (row_before != nullptr) load(row_before + channel_offset(0), from.shift(), green_before);
    }
    if ((mark.how & kInSteps) != 0 && mode == RiceMode::above) {
      Code codes[kTilePixels], held[kTilePixels];
      give(plane, codes);
      give(before, held);
      each_count_above(codes, held, from.steps(), [&](std::size_t l, std::int32_t above) {
        const auto count =
            static_cast<std::make_signed_t<Code>>(static_cast<Code>(codes[l] + (is_marked ? above / 2 : above)));
        codes[l] = static_cast<Code>(from.steps().moved(held[l], count));
      });
      take(codes, plane);
      store(plane, from.shift(), row + channel_offset(i));
      return;
    }
    if ((mark.how & kInSteps) != 0) {
      if (mode == RiceMode::median && row_before_that != nullptr) {
        Code back[kTilePixels];
        half_back(before, row_before_that + channel_offset(i), from.steps(), back);
        CodeLanes<Code> counts;
        take(back, counts);
        add(plane, counts, plane);
      }
      if (mode == RiceMode::drift) add_up(plane, Code{0}, plane);
      if (leans) {
        static_cast<void>(count_steps(green, green_before, from.steps(), green));
        add(plane, green, plane);
      }
      add_steps(before, from.steps(), plane);
      store(plane, from.shift(), row + channel_offset(i));
      return;
    }
    if (leans) subtract(before, green_before, before);
    switch (mode) {
      case RiceMode::before: add(plane, before, plane); break;
      case RiceMode::above: add_up(plane, before.part[0][0], plane); break;
      case RiceMode::drift:
        add_up(plane, Code{0}, plane);
        add(plane, before, plane);
        break;
      case RiceMode::median: add_medians(plane, corner, leans); break;
    }
    if (leans) add(plane, green, plane);
    store(plane, from.shift(), row + channel_offset(i));
  }

  static void add_medians(CodeLanes<Code>& lanes, Code& corner, bool leans) {
    Plane<Code> around, plane;
    around.fill(corner);
    give(lanes, plane.data());
    Residuals residuals;
    for (std::size_t l = 0; l < kTilePixels; ++l) {
      residuals[l] = static_cast<std::make_signed_t<Code>>(plane[l]);
    }
    add_residuals(Mode::neighbours, residuals, around, plane);
    corner = plane[kTileSide - 1];
    if (leans) {
      for (Code& code : plane) code = static_cast<Code>(code - kHalf);
    }
    take(plane.data(), lanes);
  }

  static void encode_index(const BlockGeometry& geometry, const std::byte* body, std::uint32_t slot, RiceWriter& to) {
    if (geometry.index_bytes() == 1) {
      encode_index_of<std::uint8_t>(geometry, body, slot, to);
    } else {
      encode_index_of<std::uint16_t>(geometry, body, slot, to);
    }
  }
  static void decode_index(const BlockGeometry& geometry, std::byte* body, std::uint32_t slot, RiceReader& from) {
    if (geometry.index_bytes() == 1) {
      decode_index_of<std::uint8_t>(geometry, body, slot, from);
    } else {
      decode_index_of<std::uint16_t>(geometry, body, slot, from);
    }
  }

  template <typename Index>
  static void encode_index_of(const BlockGeometry& geometry, const std::byte* body, std::uint32_t slot,
                              RiceWriter& to) {
    CodeLanes<Index> now, before{};
    load(body + slot_offset(geometry, slot), 0, now);
    if (slot > 0) load(body + slot_offset(geometry, slot - 1), 0, before);
    subtract(now, before, now);
    write(now, sum_of(now), RiceMode::before, false, to);
  }
  template <typename Index>
  static void decode_index_of(const BlockGeometry& geometry, std::byte* body, std::uint32_t slot, RiceReader& from) {
    const RiceMark mark = from.get_mark();
    CodeLanes<Index> now, before{};
    read_plane(mark.shape, (mark.how & kTellsLines) != 0, from, now);
    if (slot > 0) load(body + slot_offset(geometry, slot - 1), 0, before);
    add(now, before, now);
    store(now, 0, body + slot_offset(geometry, slot));
  }
};
