#include "tik/row_prediction.hpp"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "system/simd_clones.hpp"

namespace nutik::tik {
namespace {

// Medians are decoded a diagonal at a time, `before` all at once: they have to save a tenth.
constexpr std::uint32_t kMedianCost = 11;
constexpr std::uint32_t kBeforeCost = 10;

// Differences are taken around the middle of the range, so that small ones of either sign are neighbours for the
// median.
template <typename Code>
constexpr Code kHalf = static_cast<Code>(1u << (8 * sizeof(Code) - 1));

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

// What is left of a plane beside what the median says of it: the first pixel is predicted by `corner_guess`, others of
// the first row by their left and others of the first column by their upper neighbour. All of it is known here, so that
// pixels need not wait for each other.
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
inline __attribute__((always_inline)) Mode choose(const Plane<Code>& now, const Plane<Code>& before,
                                                  bool is_first, Residuals& chosen) {
  subtract_medians(now, before[0], chosen);
  if (is_first) return Mode::neighbours;  // there is nothing before
  Mode best = Mode::neighbours;
  std::uint32_t least = magnitude(chosen) * kMedianCost;
  Plane<Code> drift;
  Residuals residuals;
  for (std::size_t i = 0; i < kTilePixels; ++i) {
    drift[i] = static_cast<Code>(now[i] - before[i] + kHalf<Code>);
    residuals[i] = as_signed(static_cast<Code>(now[i] - before[i]));
  }
  if (const std::uint32_t sum = magnitude(residuals) * kBeforeCost; sum <= least) {
    least = sum;
    best = Mode::before;
    chosen = residuals;
  }
  subtract_medians(drift, kHalf<Code>, residuals);
  if (magnitude(residuals) * kMedianCost < least) {
    best = Mode::drift;
    chosen = residuals;
  }
  return best;
}

// What subtract_medians took from. A pixel waits for its left, its upper and its upper left neighbour, so that the
// pixels of a diagonal, x + y = k, are known together: their value for row y is in lane y.
template <typename Code>
inline __attribute__((always_inline)) void add_medians(const Residuals& residuals, Code corner_guess,
                                                       Plane<Code>& plane) {
  using Diagonal = std::uint16_t __attribute__((vector_size(2 * kTileSide)));
  constexpr std::size_t kDiagonals = 2 * kTileSide - 1;
  // A lane whose row has not begun goes down the first column with the others, so that its row's first pixel finds its
  // upper neighbour on its left too: the median of two that are equal is what they are. What lies behind a row's end
  // reaches no pixel.
  std::uint16_t values[kDiagonals * kTileSide] = {};
  for (std::size_t y = 0; y < kTileSide; ++y) {
    for (std::size_t k = 0; k < y; ++k) {
      values[k * kTileSide + y] = static_cast<std::uint16_t>(residuals[k * kTileSide]);
    }
    for (std::size_t x = 0; x < kTileSide; ++x) {
      values[(x + y) * kTileSide + y] = static_cast<std::uint16_t>(residuals[y * kTileSide + x]);
    }
  }
  Diagonal last = Diagonal{} + corner_guess, last_but_one = last;
  for (std::size_t k = 0; k < kDiagonals; ++k) {
    const Diagonal& left = last;
    const Diagonal above = __builtin_shufflevector(last, last, 0, 0, 1, 2, 3, 4, 5, 6);
    const Diagonal corner = __builtin_shufflevector(last_but_one, last_but_one, 0, 0, 1, 2, 3, 4, 5, 6);
    const Diagonal low = left < above ? left : above, high = left < above ? above : left;
    // The median of left, above and left + above - corner, without leaving 16 bits.
    Diagonal between = corner < low ? low : corner;
    between = between > high ? high : between;
    Diagonal residual;
    std::memcpy(&residual, values + k * kTileSide, sizeof residual);
    const Diagonal now = (left + above + residual - between) & static_cast<Code>(-1);
    std::memcpy(values + k * kTileSide, &now, sizeof now);
    last_but_one = last;
    last = now;
  }
  for (std::size_t y = 0; y < kTileSide; ++y) {
    for (std::size_t x = 0; x < kTileSide; ++x) {
      plane[y * kTileSide + x] = static_cast<Code>(values[(x + y) * kTileSide + y]);
    }
  }
}

template <typename Code>
inline __attribute__((always_inline)) void add(Mode mode, const Residuals& residuals,
                                               const Plane<Code>& before, Plane<Code>& now) {
  switch (mode) {
    case Mode::before:
      for (std::size_t i = 0; i < kTilePixels; ++i) now[i] = static_cast<Code>(before[i] + residuals[i]);
      return;
    case Mode::neighbours: add_medians(residuals, before[0], now); return;
    case Mode::drift:
      add_medians(residuals, kHalf<Code>, now);
      for (std::size_t i = 0; i < kTilePixels; ++i)
        now[i] = static_cast<Code>(now[i] + before[i] - kHalf<Code>);
  }
}

}  // namespace

NUTIK_SIMD_CLONES Mode choose_mode(const Plane<std::uint8_t>& now, const Plane<std::uint8_t>& before,
                                   bool is_first, Residuals& chosen) {
  return choose(now, before, is_first, chosen);
}

NUTIK_SIMD_CLONES Mode choose_mode(const Plane<std::uint16_t>& now, const Plane<std::uint16_t>& before,
                                   bool is_first, Residuals& chosen) {
  return choose(now, before, is_first, chosen);
}

NUTIK_SIMD_CLONES void add_residuals(Mode mode, const Residuals& residuals, const Plane<std::uint8_t>& before,
                                     Plane<std::uint8_t>& now) {
  add(mode, residuals, before, now);
}

NUTIK_SIMD_CLONES void add_residuals(Mode mode, const Residuals& residuals,
                                     const Plane<std::uint16_t>& before, Plane<std::uint16_t>& now) {
  add(mode, residuals, before, now);
}

}  // namespace nutik::tik
