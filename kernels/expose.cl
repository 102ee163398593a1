// Exposes pixels: the integral of light times gain, from change records and boundary tables.
//
//   in:    a chunk of blocks (layout: host/imev/block.hpp), the packed tables, each pixel's function
//   out:   sums [tile][channel][64]: Σ_k v_k w_k so far, in scaled gain; added to what is there, or
//          stored where `first` is set
//   items: NUTIK_ITEM_PIXELS neighbouring pixels of a tile each; those of a tile are consecutive
//
// Between the samples j and k at which a value v was written and replaced it contributes
// v (B_k - B_j), which is v w_j where k = j + 1 (docs/model.md, "Packed tables").
#include "light.clh"

#ifndef NUTIK_CHANNELS
#error "NUTIK_CHANNELS is not set: 1 or 3"
#endif

#define NUTIK_ITEM_VECTORS (NUTIK_CHANNELS * NUTIK_GROUPS)

// One block as one work-item sees it.
typedef struct {
  uint sample_count;
  uint function_count;
  uint first;                       // samples with a weight that may not be 0: [first, last)
  uint last;
  global const real* weights;       // [sample][function]
  global const real* boundaries;    // [sample][function], one sample more
} Block;

// The functions of an item's pixels: one for all of them, or one each.
typedef struct {
  bool is_uniform;
  uint function;
  uints functions[NUTIK_GROUPS];
} Region;

// An element of an index list, whose width follows from the block's length. Clamped so that no file can
// make a kernel read outside its tables.
NUTIK_INLINE uint index_at(global const uchar* restrict list, const uint i, const uint sample_count) {
  const uint index = sample_count <= 255 ? list[i] : ((global const ushort*)list)[i];
  return min(index, sample_count);
}

NUTIK_INLINE uints indices_at(global const uchar* restrict list, const uint lane, const uint sample_count) {
  const uints index = sample_count <= 255
                          ? NUTIK_TO_UINTS(NUTIK_LOAD(list + lane))
                          : NUTIK_TO_UINTS(NUTIK_LOAD((global const ushort*)list + lane));
  return min(index, (uints)(sample_count));
}

NUTIK_INLINE uint index_list_bytes(const uint count, const uint sample_count) {
  const uint bytes = count * (sample_count <= 255 ? 1 : 2);
  return (bytes + NUTIK_BODY_UNIT - 1) / NUTIK_BODY_UNIT * NUTIK_BODY_UNIT;
}

// The weight of values held from sample `from` to sample `to`: one function's, or one for each pixel.
NUTIK_INLINE real weight_of(const Block* block, const uint from, const uint to, const uint function) {
  const uint at = from * block->function_count + function;
  if (to == from + 1) return block->weights[at];
  return block->boundaries[to * block->function_count + function] - block->boundaries[at];
}

NUTIK_INLINE reals weights_of(const Block* block, const uint from, const uint to,
                              const uints functions) {
  const uints at = from * block->function_count + functions;
  if (to == from + 1) return gather(block->weights, at);
  return gather(block->boundaries, to * block->function_count + functions) -
         gather(block->boundaries, at);
}

// Adds a row that holds from sample `from` to sample `to`.
NUTIK_INLINE void add_row(global const code* restrict codes, const uint from, const uint to,
                          const Block* block, const Region* region,
                          global const real* restrict transfer, reals* sums) {
  const real weight = region->is_uniform ? weight_of(block, from, to, region->function) : 0;
#pragma unroll
  for (uint group = 0; group < NUTIK_GROUPS; ++group) {
    const reals w = region->is_uniform ? (reals)(weight)
                                       : weights_of(block, from, to, region->functions[group]);
#pragma unroll
    for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
      const uint at = channel * NUTIK_GROUPS + group;
      sums[at] = multiply_add(
          w, light_of(codes + channel * NUTIK_TILE_PIXELS + group * NUTIK_LANES, transfer), sums[at]);
    }
  }
}

// A tile stored as rows: all of it at each sample at which anything in it changed.
NUTIK_INLINE void expose_rows(global const uchar* restrict body, const uint rows, const uint lane,
                              const Block* block, const Region* region,
                              global const real* restrict transfer, reals* sums) {
  const size_t row_codes = NUTIK_CHANNELS * NUTIK_TILE_PIXELS;
  const uint count = block->sample_count;
  if (rows == count) {
    global const code* codes = (global const code*)body + block->first * row_codes + lane;
    for (uint sample = block->first; sample < block->last; ++sample) {
      add_row(codes, sample, sample + 1, block, region, transfer, sums);
      codes += row_codes;
    }
    return;
  }
  if (rows == 1) {
    add_row((global const code*)body + lane, 0, count, block, region, transfer, sums);
    return;
  }
  global const code* codes = (global const code*)(body + index_list_bytes(rows, count)) + lane;
  uint row = 0;
  while (row + 1 < rows && index_at(body, row + 1, count) <= block->first) ++row;
  uint sample = index_at(body, row, count);
  codes += row * row_codes;
  while (row < rows && sample < block->last) {
    const uint next = ++row < rows ? index_at(body, row, count) : count;
    add_row(codes, sample, next, block, region, transfer, sums);
    codes += row_codes;
    sample = next;
  }
}

// A tile stored as records: each pixel's own changes, slot by slot.
NUTIK_INLINE void expose_records(global const uchar* restrict body, const uint slots, const uint lane,
                                 const Block* block, const Region* region,
                                 global const real* restrict transfer, reals* sums) {
  const size_t row_bytes = NUTIK_CHANNELS * NUTIK_TILE_PIXELS * NUTIK_CODE_BYTES;
  const size_t index_bytes = index_list_bytes(NUTIK_TILE_PIXELS, block->sample_count);
  const uint count = block->function_count;
#pragma unroll
  for (uint group = 0; group < NUTIK_GROUPS; ++group) {
    const uint pixel = lane + group * NUTIK_LANES;
    const uints functions = region->is_uniform ? (uints)(region->function) : region->functions[group];
    global const code* codes = (global const code*)body + pixel;
    global const uchar* slot = body + row_bytes;
    reals boundary = 0;  // boundaries are re-based: 0 at the block's first sample
    for (uint s = 0; s < slots; ++s) {
      const uints next = indices_at(slot, pixel, block->sample_count);
      const reals next_boundary = gather(block->boundaries, next * count + functions);
#pragma unroll
      for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
        const uint at = channel * NUTIK_GROUPS + group;
        sums[at] = multiply_add(next_boundary - boundary,
                                light_of(codes + channel * NUTIK_TILE_PIXELS, transfer), sums[at]);
      }
      boundary = next_boundary;
      codes = (global const code*)(slot + index_bytes) + pixel;
      slot += index_bytes + row_bytes;
    }
    const reals end = gather(block->boundaries, block->sample_count * count + functions);
#pragma unroll
    for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
      const uint at = channel * NUTIK_GROUPS + group;
      sums[at] = multiply_add(end - boundary,
                              light_of(codes + channel * NUTIK_TILE_PIXELS, transfer), sums[at]);
    }
  }
}

NUTIK_INLINE TileEntry tile_entry(global const uchar* restrict chunk, const BlockEntry* block,
                                  const size_t tile) {
  return ((global const TileEntry*)(chunk + block->payload_offset))[tile];
}

NUTIK_INLINE void expose_tile(global const uchar* restrict payload, const TileEntry entry,
                              const uint lane, const Block* block, const Region* region,
                              global const real* restrict transfer, reals* sums) {
  global const uchar* body = payload + (size_t)entry.offset * NUTIK_BODY_UNIT;
  if (entry.count & NUTIK_RECORDS_FLAG) {
    expose_records(body, entry.count & ~NUTIK_RECORDS_FLAG, lane, block, region, transfer, sums);
  } else {
    expose_rows(body, entry.count, lane, block, region, transfer, sums);
  }
}

kernel void expose(global const uchar* restrict chunk, global const BlockEntry* restrict blocks,
                   const uint block_count, global const SampleSpan* restrict spans,
                   global const real* restrict weights, global const real* restrict boundaries,
                   const uint function_count, global const ushort* restrict function_of_tile,
                   global const uchar* restrict function_of_lane,
                   global const real* restrict transfer, global real* restrict sums,
                   const ulong item_count, const uint first) {
  const size_t item = get_global_id(0);
  if (item >= item_count) return;
  const size_t tile = item / NUTIK_ITEMS_PER_TILE;
  const uint lane = (uint)(item % NUTIK_ITEMS_PER_TILE) * NUTIK_ITEM_PIXELS;

  Region region;
#if NUTIK_ITEM_PIXELS == 1
  region.is_uniform = true;
  region.function = function_of_lane[item];
#else
  region.function = function_of_tile[tile];
  region.is_uniform = region.function != NUTIK_MIXED_FUNCTIONS;
#endif
#pragma unroll
  for (uint group = 0; group < NUTIK_GROUPS; ++group) {
    region.functions[group] = NUTIK_TO_UINTS(
        NUTIK_LOAD(function_of_lane + tile * NUTIK_TILE_PIXELS + lane + group * NUTIK_LANES));
  }

  reals totals[NUTIK_ITEM_VECTORS];
#pragma unroll
  for (uint i = 0; i < NUTIK_ITEM_VECTORS; ++i) totals[i] = 0;
  // Each block's directory is looked up while the one before is read: else every block would begin with
  // waiting for memory twice.
  BlockEntry next_block = blocks[0];
  TileEntry next_tile = tile_entry(chunk, &next_block, tile);
  for (uint b = 0; b < block_count; ++b) {
    const BlockEntry entry = next_block;
    const TileEntry tile_at = next_tile;
    next_block = blocks[min(b + 1, block_count - 1)];
    next_tile = tile_entry(chunk, &next_block, tile);
    global const SampleSpan* block_spans = spans + entry.span_row * function_count;
    Block block;
    block.sample_count = entry.sample_count;
    block.function_count = function_count;
    block.weights = weights + entry.table_row * function_count;
    block.boundaries = boundaries + entry.table_row * function_count;
    if (region.is_uniform) {
      block.first = block_spans[region.function].first;
      block.last = block_spans[region.function].last;
    } else {
      block.first = 0;
      block.last = entry.sample_count;
    }
    if (block.first >= block.last) continue;

    // A block is summed on its own first: rounding errors then grow with its length, not the capture's.
    reals block_sums[NUTIK_ITEM_VECTORS];
#pragma unroll
    for (uint i = 0; i < NUTIK_ITEM_VECTORS; ++i) block_sums[i] = 0;
    // Written twice so that the compiler sees which one it compiles.
    if (region.is_uniform) {
      region.is_uniform = true;
      expose_tile(chunk + entry.payload_offset, tile_at, lane, &block, &region, transfer, block_sums);
    } else {
      region.is_uniform = false;
      expose_tile(chunk + entry.payload_offset, tile_at, lane, &block, &region, transfer, block_sums);
    }
#pragma unroll
    for (uint i = 0; i < NUTIK_ITEM_VECTORS; ++i) totals[i] += block_sums[i];
  }

#pragma unroll
  for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
#pragma unroll
    for (uint group = 0; group < NUTIK_GROUPS; ++group) {
      global real* to =
          sums + (tile * NUTIK_CHANNELS + channel) * NUTIK_TILE_PIXELS + lane + group * NUTIK_LANES;
      const reals total = totals[channel * NUTIK_GROUPS + group];
      NUTIK_STORE(first ? total : NUTIK_LOAD(to) + total, to);
    }
  }
}
