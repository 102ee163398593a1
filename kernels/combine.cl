// Combines pixels: the lightest or the darkest of their samples, each times its gain.
//
//   in:    chunk, entries, tiles and functions as expose.cl has them; the samples of a block that each function
//          exposes. Where it scales them, gains [level][row][function]: level i has the extreme of 2^i samples, so that
//          two of them make up any run. A sample that is not exposed has the gain that changes nothing; each block has
//          one row more than samples, of those gains
//   out:   results [tile][channel][64]: the extreme so far
//   items: see items.clh
//
// If all samples have one gain (NUTIK_SCALES is 0), nothing is rounded: codes are compared as they come, and the host
// turns the one that is left into light. Else products are compared, each rounded once as IEEE 754 says, also on
// devices without double: the bits of doubles from 0 on are in the order of their values.
#include "items.clh"
#include "tiles.clh"

#ifndef NUTIK_DARKENS
#error "NUTIK_DARKENS is not set: 1 for the darkest sample, 0 for the lightest"
#endif
#ifndef NUTIK_SCALES
#error "NUTIK_SCALES is not set: 1 where gains are not one and the same, else 0"
#endif

#if !NUTIK_SCALES
#define NUTIK_RESULT NUTIK_CODE
#elif NUTIK_PRECISION == NUTIK_DOUBLE
#define NUTIK_RESULT double
#else
#define NUTIK_RESULT ulong
#endif
typedef NUTIK_RESULT result;
typedef NUTIK_VECTOR(NUTIK_RESULT) results;

#define NUTIK_INFINITE 0x7ff0000000000000ul
#if NUTIK_DARKENS
#define NUTIK_BETTER(a, b) ((b) < (a) ? (b) : (a))
#else
#define NUTIK_BETTER(a, b) ((b) > (a) ? (b) : (a))
#endif

// What any sample is better than.
NUTIK_INLINE result nothing() {
#if !NUTIK_DARKENS
  return 0;
#elif !NUTIK_SCALES
  return (result)~0u;
#elif NUTIK_PRECISION == NUTIK_DOUBLE
  return INFINITY;
#else
  return NUTIK_INFINITE;
#endif
}

#if NUTIK_SCALES
#if NUTIK_PRECISION == NUTIK_DOUBLE
// Infinity times 0 is no number, and no better than any.
NUTIK_INLINE results product(const results gain, const results light) { return gain * light; }
#else
// The nearest double, the even one of two; none is subnormal.
NUTIK_INLINE results product(const results gain, const results light) {
  const results one = (results)(1ul << 52), zero = (results)(0ul);
  const results a = ((gain & (one - 1)) | one) << 11, b = ((light & (one - 1)) | one) << 11;
  const results top = mul_hi(a, b), bottom = a * b;  // 2^62 and more
  const results shift = (results)(1ul) - (top >> 63);
  const results high = (top << shift) | (shift & (bottom >> 63)), low = bottom << shift;
  const results bits = high >> 11;
  const results rest = ((high & (results)(0x7fful)) << 1) | (low != zero ? (results)(1ul) : zero);
  const results up = rest + (bits & 1) > (results)(0x800ul) ? (results)(1ul) : zero;
  const results exponent = (gain >> 52) + (light >> 52) - 1022 - shift;
  const results rounded = (exponent << 52) + (bits - one) + up;
  const results some = gain == zero ? zero : light == zero ? zero : rounded;
  return gain == (results)(NUTIK_INFINITE) ? gain : some;
}
#endif

// The extreme gain of samples [from, to) of a block, for each lane.
NUTIK_INLINE results gains_of(global const result* gains, const uint rows, const uint functions, const uints from,
                              const uints to, const uints function) {
  const uints level = (uints)(31) - clz(to - from);
  const uints first = (level * rows + from) * functions + function;
  const uints last = (level * rows + to - ((uints)(1) << level)) * functions + function;
  const results a = (results)(NUTIK_GATHER(gains, first, )), b = (results)(NUTIK_GATHER(gains, last, ));
  return NUTIK_BETTER(a, b);
}
#endif

// A block as one work-item sees it, and what its samples are scaled by.
typedef struct {
  uint sample_count;
  uint function_count;
  uint rows;                       // of a level
  global const BlockPart* parts;   // [function]
  global const result* gains;      // of its first sample, level 0
  global const result* light;      // of each code
} Samples;

// What a code that is held in samples [from, to) is scaled by in each lane. Codes that are compared as they come keep
// all of their bits where some of the samples is exposed, and none elsewhere.
NUTIK_INLINE results scales_of(const Samples* samples, const uints from, const uints to, const uints functions) {
#if NUTIK_SCALES
  return gains_of(samples->gains, samples->rows, samples->function_count, from, to, functions);
#else
  const uints first = (uints)(NUTIK_GATHER(samples->parts, functions, .first));
  const uints last = (uints)(NUTIK_GATHER(samples->parts, functions, .last));
  return NUTIK_CONVERT(NUTIK_CODE)(-(NUTIK_ONE_WHERE(from < last) & NUTIK_ONE_WHERE(to > first)));
#endif
}

// The same of one function in all lanes. Rows outside what it exposes are not asked for.
NUTIK_INLINE results scale_of(const Samples* samples, const uint from, const uint to, const uint function) {
#if NUTIK_SCALES
  const uint level = 31 - clz(to - from);
  global const result* of_function = samples->gains + function;
  const result a = of_function[(level * samples->rows + from) * samples->function_count];
  const result b = of_function[(level * samples->rows + to - (1u << level)) * samples->function_count];
  return (results)(NUTIK_BETTER(a, b));
#else
  return (results)((result)~0u);
#endif
}

NUTIK_INLINE void combine_group(global const code* codes, const results scale, const Samples* samples,
                                results* combined) {
#pragma unroll
  for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
    global const code* of_channel = codes + channel * NUTIK_TILE_PIXELS;
#if NUTIK_SCALES
    const uints at = NUTIK_TO_UINTS(NUTIK_LOAD_CODES(of_channel));
    const results value = product(scale, (results)(NUTIK_GATHER(samples->light, at, )));
#elif NUTIK_DARKENS
    const results value = NUTIK_LOAD_CODES(of_channel) | ~scale;
#else
    const results value = NUTIK_LOAD_CODES(of_channel) & scale;
#endif
    results* to = combined + channel * NUTIK_GROUPS;
    *to = NUTIK_BETTER(*to, value);
  }
}

// A tile stored as rows. `functions` of its pixels are looked at where they are not all `function`.
NUTIK_INLINE void combine_rows(global const uchar* body, const uint rows, const uint lane, const Samples* samples,
                               const uint function, global const function_index* functions, results* combined) {
  const uint count = samples->sample_count;
  const bool is_uniform = function != NUTIK_MIXED_FUNCTIONS;
  const bool is_indexed = rows != 1 && rows != count;
  const uint begin = is_uniform ? samples->parts[function].first : 0;
  const uint end = is_uniform ? samples->parts[function].last : count;
  uint row = rows == count ? begin : 0;
  if (is_indexed) {
    while (row + 1 < rows && index_at(body, row + 1, count) <= begin) ++row;
  }
  uint sample = is_indexed ? index_at(body, row, count) : row;
  const size_t row_codes = NUTIK_CHANNELS * NUTIK_TILE_PIXELS;
  global const code* codes =
      (global const code*)(body + (is_indexed ? index_list_bytes(rows, count) : 0)) + row * row_codes + lane;
  while (row < rows && sample < end) {
    ++row;
    const uint next = max(row == rows ? count : is_indexed ? index_at(body, row, count) : row, sample + 1);
    if (is_uniform) {
      const results scale = scale_of(samples, sample, next, function);
#pragma unroll
      for (uint group = 0; group < NUTIK_GROUPS; ++group) {
        combine_group(codes + group * NUTIK_LANES, scale, samples, combined + group);
      }
    } else {
#pragma unroll 1
      for (uint group = 0; group < NUTIK_GROUPS; ++group) {
        const results scale = scales_of(samples, (uints)(sample), (uints)(next),
                                        NUTIK_TO_UINTS(NUTIK_LOAD(functions + group * NUTIK_LANES)));
        combine_group(codes + group * NUTIK_LANES, scale, samples, combined + group);
      }
    }
    codes += row_codes;
    sample = next;
  }
}

// A tile stored as records. A slot behind a pixel's last one holds no sample: the row behind the block's last changes
// nothing.
NUTIK_INLINE void combine_records(global const uchar* body, const uint slots, const uint lane, const Samples* samples,
                                  global const function_index* functions, results* combined) {
  const size_t row_bytes = NUTIK_CHANNELS * NUTIK_TILE_PIXELS * NUTIK_CODE_BYTES;
  const size_t index_bytes = index_list_bytes(NUTIK_TILE_PIXELS, samples->sample_count);
#pragma unroll 1
  for (uint group = 0; group < NUTIK_GROUPS; ++group) {
    const uint pixel = lane + group * NUTIK_LANES;
    const uints of_pixels = NUTIK_TO_UINTS(NUTIK_LOAD(functions + group * NUTIK_LANES));
    global const code* codes = (global const code*)body + pixel;
    global const uchar* slot = body + row_bytes;
    uints from = (uints)(0);
    for (uint s = 0; s <= slots; ++s) {
      const uints next =
          s < slots ? indices_at(slot, pixel, samples->sample_count) : (uints)(samples->sample_count);
      combine_group(codes, scales_of(samples, from, max(next, from + 1), of_pixels), samples, combined + group);
      from = next;
      codes = (global const code*)(slot + index_bytes) + pixel;
      slot += index_bytes + row_bytes;
    }
  }
}

kernel void combine(global const uchar* restrict chunk, global const BlockEntry* restrict blocks,
                    global const BlockPart* restrict parts, global const result* restrict gains,
                    global const result* restrict light, global const uint* restrict tiles,
                    global const ushort* restrict function_of_tile,
                    global const function_index* restrict function_of_lane, global result* restrict picture,
                    const uint rows, const ExposeLaunch launch) {
  const Item item = item_of(get_global_id(0), launch.tile_count);
  for (uint b = 0; b < launch.block_count; ++b) {
    const BlockEntry of_host = blocks[b];
    global const uchar* payload = chunk + of_host.payload_offset;
    Samples samples;
    samples.sample_count = of_host.sample_count;
    samples.function_count = launch.function_count;
    samples.rows = rows;
    samples.parts = parts + of_host.part_row * launch.function_count;
    samples.gains = gains + of_host.table_row * launch.function_count;
    samples.light = light;
    for (size_t in_band = item.first_tile; in_band < item.last_tile; ++in_band) {
      const uint function = function_of_tile[in_band];
      if (!(launch.is_first && b == 0) && function != NUTIK_MIXED_FUNCTIONS &&
          samples.parts[function].first >= samples.parts[function].last)
        continue;
      global const function_index* functions = function_of_lane + in_band * NUTIK_TILE_PIXELS + item.lane;
      global result* const to = picture + in_band * NUTIK_CHANNELS * NUTIK_TILE_PIXELS + item.lane;
      results combined[NUTIK_ITEM_VECTORS];
#pragma unroll
      for (uint i = 0; i < NUTIK_ITEM_VECTORS; ++i) {
        combined[i] = launch.is_first && b == 0
                          ? (results)(nothing())
                          : NUTIK_LOAD(to + i / NUTIK_GROUPS * NUTIK_TILE_PIXELS + i % NUTIK_GROUPS * NUTIK_LANES);
      }
      const TileEntry entry = ((global const TileEntry*)payload)[tiles[in_band]];
      global const uchar* body = payload + (size_t)entry.offset * NUTIK_BODY_UNIT;
      const uint count = entry.count & ~NUTIK_RECORDS_FLAG;
      if (entry.count & NUTIK_RECORDS_FLAG) {
        combine_records(body, count, item.lane, &samples, functions, combined);
      } else {
        combine_rows(body, count, item.lane, &samples, function, functions, combined);
      }
#pragma unroll
      for (uint i = 0; i < NUTIK_ITEM_VECTORS; ++i) {
        NUTIK_STORE(combined[i], to + i / NUTIK_GROUPS * NUTIK_TILE_PIXELS + i % NUTIK_GROUPS * NUTIK_LANES);
      }
    }
  }
}
