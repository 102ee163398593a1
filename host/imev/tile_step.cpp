// The innermost loops are clones for several instruction sets: else the transposition of a frame takes longer than
// decoding it.
#include "imev/tile_step.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <type_traits>

#include "system/simd_clones.hpp"

namespace nutik {
namespace {

std::uint32_t code_at(const CaptureFormat& capture, const std::byte* row, std::uint32_t channel,
                      std::uint32_t lane) {
  // Little-endian: the low byte of a wider code is its first.
  std::uint16_t code = 0;
  std::memcpy(&code, row + (channel * kTilePixels + lane) * capture.code_bytes, capture.code_bytes);
  return code;
}

void set_code(const CaptureFormat& capture, std::byte* row, std::uint32_t channel, std::uint32_t lane,
              std::uint32_t code) {
  const auto stored = static_cast<std::uint16_t>(code);
  std::memcpy(row + (channel * kTilePixels + lane) * capture.code_bytes, &stored, capture.code_bytes);
}

bool is_further(const CaptureFormat& capture, const std::byte* held, const std::byte* row,
                std::uint32_t lane) {
  for (std::uint32_t channel = 0; channel < capture.shape.channels; ++channel) {
    const std::uint32_t before = code_at(capture, held, channel, lane),
                        after = code_at(capture, row, channel, lane);
    if ((before > after ? before - after : after - before) > capture.noise.tolerance) return true;
  }
  return false;
}

// Moves one tile from an interleaved raster to planes: codes[channel][lane]. `row_values` is the number
// of values from one raster row to the next.
template <typename Code, std::uint32_t Channels>
inline __attribute__((always_inline)) void gather_tile(const Code* raster, std::size_t row_values,
                                                       Code* codes) {
  for (std::uint32_t y = 0; y < kTileSide; ++y) {
    const Code* from = raster + y * row_values;
    for (std::uint32_t channel = 0; channel < Channels; ++channel) {
      for (std::uint32_t x = 0; x < kTileSide; ++x) {
        codes[channel * kTilePixels + y * kTileSide + x] = from[x * Channels + channel];
      }
    }
  }
}

// The same for 8-bit colour, which most clips are: a row's 24 bytes are read as two overlapping vectors and
// each plane's 8 picked from them: 2.5 ms a frame of 1080p instead of the plain loop's 4.2.
template <>
inline __attribute__((always_inline)) void gather_tile<std::uint8_t, 3>(const std::uint8_t* raster,
                                                                        std::size_t row_values,
                                                                        std::uint8_t* codes) {
  using Bytes = std::uint8_t __attribute__((vector_size(16)));
  for (std::uint32_t y = 0; y < kTileSide; ++y) {
    Bytes low, high;  // bytes 0 … 15 and 8 … 23 of the row: byte k of these is k or, from 16 on, k + 8
    std::memcpy(&low, raster + y * row_values, 16);
    std::memcpy(&high, raster + y * row_values + 8, 16);
    const Bytes first = __builtin_shufflevector(low, high, 0, 3, 6, 9, 12, 15, 26, 29,  //
                                                1, 4, 7, 10, 13, 24, 27, 30);
    const Bytes last = __builtin_shufflevector(low, high, 2, 5, 8, 11, 14, 25, 28, 31,  //
                                               2, 5, 8, 11, 14, 25, 28, 31);
    std::memcpy(codes + y * kTileSide, &first, 8);
    std::memcpy(codes + kTilePixels + y * kTileSide, reinterpret_cast<const char*>(&first) + 8, 8);
    std::memcpy(codes + 2 * kTilePixels + y * kTileSide, &last, 8);
  }
}

// Values for some lanes of a tile, in vectors that every machine has: of longer ones GCC 12 takes comparisons apart
// code by code, 17 ms a frame of 1080p with AVX2 instead of 1.3.
using Lanes8 = std::uint8_t __attribute__((vector_size(16)));
using Lanes16 = std::uint16_t __attribute__((vector_size(16)));
using HalfLanes8 = std::uint8_t __attribute__((vector_size(8)));

// Lanes 0 … 63 of `differs`, each 0 or 1, as bits 0 … 63.
inline __attribute__((always_inline)) std::uint64_t pack_lanes(const std::uint8_t* differs) {
  std::uint64_t bits = 0;
  for (std::uint32_t byte = 0; byte < 8; ++byte) {
    std::uint64_t eight;
    std::memcpy(&eight, differs + byte * 8, 8);
    bits |= (eight * 0x0102'0408'1020'4080u >> 56) << (byte * 8);
  }
  return bits;
}

// The lanes, as bits, in which any channel of `now` is further than `limit` from `held`, which is given its codes
// there.
template <typename Code, std::uint32_t Channels>
inline __attribute__((always_inline)) std::uint64_t compare(const Code* now_codes, Code* held_codes,
                                                            Code limit) {
  using Lanes = std::conditional_t<sizeof(Code) == 1, Lanes8, Lanes16>;
  using Marks = std::conditional_t<sizeof(Code) == 1, Lanes8, HalfLanes8>;
  std::uint8_t bytes[kTilePixels];
  for (std::size_t first = 0; first < kTilePixels; first += sizeof(Lanes) / sizeof(Code)) {
    Lanes now[Channels], held[Channels], differs{};
    for (std::uint32_t channel = 0; channel < Channels; ++channel) {
      std::memcpy(&now[channel], now_codes + channel * kTilePixels + first, sizeof(Lanes));
      std::memcpy(&held[channel], held_codes + channel * kTilePixels + first, sizeof(Lanes));
      const Lanes distance =
          now[channel] > held[channel] ? now[channel] - held[channel] : held[channel] - now[channel];
      differs |= reinterpret_cast<Lanes>(distance > limit);
    }
    for (std::uint32_t channel = 0; channel < Channels; ++channel) {
      const Lanes next = (now[channel] & differs) | (held[channel] & ~differs);
      std::memcpy(held_codes + channel * kTilePixels + first, &next, sizeof next);
    }
    const Marks marks = __builtin_convertvector(differs, Marks) & 1;
    std::memcpy(bytes + first, &marks, sizeof marks);
  }
  return pack_lanes(bytes);
}

// The same with a tolerance: what is held moves by steps.
template <typename Code, std::uint32_t Channels>
inline __attribute__((always_inline)) std::uint64_t compare_in_steps(const Code* now_codes, Code* held_codes,
                                                                     Code limit, const CodeSteps steps) {
  Code reached[Channels * kTilePixels];
  std::memcpy(reached, held_codes, sizeof reached);
  const std::uint64_t changed = compare<Code, Channels>(now_codes, reached, limit);
  if (changed == 0) return 0;
  for (std::uint32_t i = 0; i < Channels * kTilePixels; ++i)
    held_codes[i] = static_cast<Code>(steps.nearest(held_codes[i], reached[i]));
  return changed;
}

template <typename Code, std::uint32_t Channels>
inline __attribute__((always_inline)) void step_strip(StripStep& step) {
  constexpr std::size_t kRowBytes = sizeof(Code) * Channels * kTilePixels;
  using Row = Code[Channels * kTilePixels];
  alignas(64) Row now[kStripTiles], held[kStripTiles];
  const std::uint32_t tiles = std::min(step.tile_count, kStripTiles),
                      samples = std::min(step.sample_count, kStepSamples);
  // No distance is above the largest code: a larger tolerance means the same, but would not fit.
  const auto limit =
      static_cast<Code>(std::min<std::uint32_t>(step.tolerance, std::numeric_limits<Code>::max()));
  for (std::uint32_t i = 0; i < tiles; ++i) std::memcpy(held[i], step.held[i], kRowBytes);
  step.change_counts.fill(0);
  for (std::uint32_t k = 0; k < samples; ++k) {
    const auto* raster = reinterpret_cast<const Code*>(step.rasters[k]);
    for (std::uint32_t i = 0; i < tiles; ++i) {
      gather_tile<Code, Channels>(raster + i * kTileSide * Channels, step.row_values, now[i]);
    }
    for (std::uint32_t i = 0; i < tiles; ++i) {
      step.changes[k][i] = limit == 0 ? compare<Code, Channels>(now[i], held[i], limit)
                                      : compare_in_steps<Code, Channels>(now[i], held[i], limit, step.steps);
      if (step.changes[k][i] == 0 && !step.writes_all) continue;
      std::memcpy(step.next[i], held[i], kRowBytes);
      step.next[i] += kRowBytes;
      step.change_counts[i] += static_cast<std::uint32_t>(std::popcount(step.changes[k][i]));
    }
  }
}

template <typename Code, std::uint32_t Channels>
inline __attribute__((always_inline)) std::uint64_t differ(const std::byte* a, const std::byte* b) {
  Code held[Channels * kTilePixels];
  std::memcpy(held, b, sizeof held);
  return compare<Code, Channels>(reinterpret_cast<const Code*>(a), held, 0);
}

template <typename Code, std::uint32_t Channels>
inline __attribute__((always_inline)) void gather(const TileRaster& raster, std::byte* codes) {
  gather_tile<Code, Channels>(reinterpret_cast<const Code*>(raster.codes), raster.row_values,
                              reinterpret_cast<Code*>(codes));
}

// Each function for grey and colour, 8 and 16 bits.
#define NUTIK_FOR_FORMAT(name, Code, channels)                                              \
  NUTIK_SIMD_CLONES void step_##name(StripStep& step) { step_strip<Code, channels>(step); } \
  NUTIK_SIMD_CLONES void gather_##name(const TileRaster& raster, std::byte* codes) {        \
    gather<Code, channels>(raster, codes);                                                  \
  }                                                                                         \
  NUTIK_SIMD_CLONES std::uint64_t differ_##name(const std::byte* a, const std::byte* b) {   \
    return differ<Code, channels>(a, b);                                                    \
  }
NUTIK_FOR_FORMAT(grey8, std::uint8_t, 1)
NUTIK_FOR_FORMAT(grey16, std::uint16_t, 1)
NUTIK_FOR_FORMAT(colour8, std::uint8_t, 3)
NUTIK_FOR_FORMAT(colour16, std::uint16_t, 3)
#undef NUTIK_FOR_FORMAT

template <typename Function>
Function pick(std::uint32_t channels, std::uint32_t code_bytes, const std::array<Function, 4>& functions) {
  return functions[(channels == 1 ? 0 : 2) + code_bytes - 1];
}

}  // namespace

void write_change(const CaptureFormat& capture, const PixelChange& change, std::byte* row) {
  const Shape& shape = capture.shape;
  const std::uint32_t x = change.pixel % shape.width, y = change.pixel / shape.width;
  const std::uint32_t left = x % kTileSide, top = y % kTileSide;
  const std::uint32_t right = x + 1 == shape.width ? kTileSide - 1 : left;
  const std::uint32_t bottom = y + 1 == shape.height ? kTileSide - 1 : top;
  for (std::uint32_t channel = 0; channel < shape.channels; ++channel) {
    for (std::uint32_t down = top; down <= bottom; ++down) {
      for (std::uint32_t across = left; across <= right; ++across) {
        set_code(capture, row, channel, down * kTileSide + across, change.codes[channel]);
      }
    }
  }
}

std::uint64_t differing_lanes(const CaptureFormat& capture, const std::byte* held, std::byte* row) {
  const CodeSteps steps = CodeSteps::of(capture);
  std::uint64_t further = 0;
  for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
    const bool changed = is_further(capture, held, row, lane);
    further |= std::uint64_t{changed} << lane;
    for (std::uint32_t channel = 0; channel < capture.shape.channels; ++channel) {
      const std::uint32_t before = code_at(capture, held, channel, lane), after = code_at(capture, row, channel, lane);
      const std::int32_t moved = steps.nearest(static_cast<std::int32_t>(before), static_cast<std::int32_t>(after));
      set_code(capture, row, channel, lane, changed ? static_cast<std::uint32_t>(moved) : before);
    }
  }
  return further;
}

StepFunction step_function(const CaptureFormat& capture) {
  return pick<StepFunction>(capture.shape.channels, capture.code_bytes,
                            {step_grey8, step_grey16, step_colour8, step_colour16});
}

GatherFunction gather_function(const CaptureFormat& capture) {
  return pick<GatherFunction>(capture.shape.channels, capture.code_bytes,
                              {gather_grey8, gather_grey16, gather_colour8, gather_colour16});
}

DifferFunction differ_function(std::uint32_t channels, std::uint32_t code_bytes) {
  return pick<DifferFunction>(channels, code_bytes,
                              {differ_grey8, differ_grey16, differ_colour8, differ_colour16});
}

}  // namespace nutik
