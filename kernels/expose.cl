// Exposes pixels: the integral of light times gain, from change records and boundary tables.
//
//   chunk   | block             | block             | block …      entries say where each one starts
//           |                    \
//   block   | directory | tile | tile | tile …                     the directory says where each one lies
//                       |       \
//   tile    | row | row | row …       of 64 pixels each, or        (host/imev/block.hpp)
//           | slot | slot | slot …    of changes, one a pixel
//
//   for each entry, in time order
//     for each tile of the work-item
//       its pixels have one function:     expose_one(): sum of the block, made or kept, times a steady gain
//       they have several:                expose_several(): sum of the block, times each pixel's gain
//       both add it to the picture's sums
//
//   in:    a chunk of blocks, the packed tables; of a band of the picture its tiles, each with its number in the
//          picture, and each pixel's function. A tile whose pixels several functions share is there once for each of
//          them. By function, whether it is exposed: of others the sums are there. Sums of blocks, halves and bundles
//          that were made before: [kept][tile][channel][plane][64]
//   out:   sums [tile][channel][plane][64]: Σ_k v_k w_k so far, in scaled gain; added to what is there,
//          or stored where launch.is_first is set. Those of bundles so far, likewise
//   items: see items.clh
//
// Where a function's gain is steady, a block's sum is that of light · ns, the same for every such function, and is
// multiplied by the gain afterwards (docs/explanation/model.md, "Steady gain"): made here or kept, to the same bits.
#include "items.clh"
#include "tiles.clh"

// Adds the sums of a block, a half or a bundle to the picture's, which start with the first entry: with 0, for which
// entry comes first depends on what is kept, and 0 + -0 is 0.
NUTIK_INLINE void add_sums(global Sum* sums, const size_t tile, const uint lane, const Sums* block_sums,
                           const bool is_start) {
#pragma unroll
  for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
#pragma unroll
    for (uint group = 0; group < NUTIK_GROUPS; ++group) {
      global Sum* to = sums + sums_at(tile, NUTIK_CHANNELS, channel, lane + group * NUTIK_LANES);
      const Sums sum = block_sums[channel * NUTIK_GROUPS + group];
      store_sums(add(is_start ? zero() : load_sums(to), sum), to);
    }
  }
}

NUTIK_INLINE void load_tile(global const Sum* from, const size_t tile, const uint lane, Sums* sums) {
#pragma unroll
  for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
#pragma unroll
    for (uint group = 0; group < NUTIK_GROUPS; ++group) {
      sums[channel * NUTIK_GROUPS + group] =
          load_sums(from + sums_at(tile, NUTIK_CHANNELS, channel, lane + group * NUTIK_LANES));
    }
  }
}

// Times the gain of one function.
NUTIK_INLINE void scale(const Weight gain, Sums* sums) {
#pragma unroll
  for (uint i = 0; i < NUTIK_ITEM_VECTORS; ++i) sums[i] = times(same_weights(gain), sums[i]);
}

// Sums of a band: those that kernels add to, and those that were made before.
typedef struct {
  global Sum* picture;
  global Sum* bundles;
  global const Sum* kept;
} BandSums;

// An entry: a block of the chunk, or a kept sum in a block's place.
typedef struct {
  bool is_start;                  // nothing was added to the picture before
  bool is_kept;
  uint kept;                      // BlockEntry.kept_bits
  ulong kept_at;                  // of a kept sum its place
  Block block;
  global const uchar* payload;    // the block's
  global const BlockPart* parts;  // [function]
  global const Weight* gains;     // [function]
} Entry;

// A tile of the band, and the work-item's pixels of it.
typedef struct {
  size_t in_band;
  size_t in_picture;
  uint lane;
} Tile;

NUTIK_INLINE void expose_block(const Entry* entry, const Tile tile, const Block* block, const Region* region,
                               LightTable transfer, Sums* sums) {
  global const TileEntry* directory = (global const TileEntry*)entry->payload;
  expose_tile(entry->payload, directory[tile.in_picture], tile.lane, block, region, transfer, sums);
}

// Adds an entry to pixels of one function.
NUTIK_INLINE void expose_one(const Entry* entry, const Tile tile, const uint function,
                             LightTable transfer, const BandSums band) {
  const BlockPart part = entry->parts[function];
  const uint kept_as = part.bits ? 1u << (part.bits >> NUTIK_SUM_SHIFT) : 0;
  const bool is_of_kept = entry->kept & kept_as;
  bool adds = part.first < part.last && entry->is_kept == is_of_kept;
  Sums sums[NUTIK_ITEM_VECTORS];
  clear(sums);
  if (adds && entry->is_kept) {
    load_tile(band.kept + entry->kept_at, tile.in_picture, tile.lane, sums);
  } else if (adds) {
    Block block = entry->block;
    block.first = part.first;
    block.last = part.last;
    Region region;
    region.is_uniform = true;
    region.function = function;
    expose_block(entry, tile, &block, &region, transfer, sums);
    if (part.bits & NUTIK_IN_BUNDLE) {
      add_sums(band.bundles, tile.in_band, tile.lane, sums, part.bits & NUTIK_BUNDLE_START);
      adds = part.bits & NUTIK_BUNDLE_END;
      if (adds) load_tile(band.bundles, tile.in_band, tile.lane, sums);
      else clear(sums);
    }
  }
  if (!adds && !entry->is_start) return;
  if (part.bits) scale(entry->gains[function], sums);
  add_sums(band.picture, tile.in_band, tile.lane, sums, entry->is_start);
}

#if NUTIK_ITEM_PIXELS > 1
// Times the gain of each pixel's function: exactly 1 where it is not steady.
NUTIK_INLINE void scale_each(global const Weight* gains, global const function_index* functions, Sums* sums) {
#pragma unroll
  for (uint group = 0; group < NUTIK_GROUPS; ++group) {
    const Weights gain = pick_weights(gains, functions + group * NUTIK_LANES, 1);
#pragma unroll
    for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
      sums[channel * NUTIK_GROUPS + group] = times(gain, sums[channel * NUTIK_GROUPS + group]);
    }
  }
}

#if NUTIK_FUNCTION_BYTES == 2
// The samples of a block that any of the item's pixels needs: with delays few of those that some pixel of the picture
// does. A tile that needs none need not be there.
NUTIK_INLINE void narrow(Block* block, global const BlockPart* parts,
                         global const function_index* functions) {
  uint first = block->sample_count, last = 0;
  for (uint i = 0; i < NUTIK_ITEM_PIXELS; ++i) {
    const BlockPart part = parts[functions[i]];
    if (part.first >= part.last) continue;
    first = min(first, (uint)part.first);
    last = max(last, (uint)part.last);
  }
  block->first = first;
  block->last = last;
}
#endif

// Adds an entry to pixels of several functions, which have no kept sums.
NUTIK_INLINE void expose_several(const Entry* entry, const Tile tile, global const function_index* functions,
                                 LightTable transfer, const BandSums band) {
  if (entry->is_kept && !entry->is_start) return;
  Sums sums[NUTIK_ITEM_VECTORS];
  clear(sums);
  Block block = entry->block;
  block.first = 0;
  block.last = entry->is_kept ? 0 : block.sample_count;
#if NUTIK_FUNCTION_BYTES == 2
  if (!entry->is_kept) narrow(&block, entry->parts, functions);
  if (block.first >= block.last && !entry->is_start) return;
#endif
  if (block.first < block.last) {
    Region region;
    region.is_uniform = false;
    region.functions = functions;
    expose_block(entry, tile, &block, &region, transfer, sums);
    scale_each(entry->gains, functions, sums);
  }
  add_sums(band.picture, tile.in_band, tile.lane, sums, entry->is_start);
}
#endif

kernel void expose(global const uchar* restrict chunk, global const BlockEntry* restrict blocks,
                   global const BlockPart* restrict parts, global const Weight* restrict gains,
                   global const Weight* restrict weights, global const Weight* restrict boundaries,
                   global const uint* restrict tiles, global const ushort* restrict function_of_tile,
                   global const function_index* restrict function_of_lane, global const uchar* restrict exposes,
                   global const Light* restrict light, global const Sum* restrict kept,
                   global Sum* restrict bundles, global Sum* restrict sums, const ExposeLaunch launch) {
  const Item item = item_of(get_global_id(0), launch.tile_count);
  const BandSums band = {sums, bundles, kept};
#if NUTIK_TABLE_COPIES > 0
  local Light copies[256 * NUTIK_TABLE_COPIES];
  for (uint i = get_local_id(0); i < 256 * NUTIK_TABLE_COPIES; i += get_local_size(0)) {
    copies[i] = light[i / NUTIK_TABLE_COPIES];
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  const LightTable transfer = copies + get_local_id(0) % NUTIK_TABLE_COPIES;
#else
  const LightTable transfer = light + NUTIK_BYTE_TABLES * 256;
#endif

  // Block by block, not tile by tile: a block's tiles lie one after the other in memory. A block is summed
  // on its own before it is added, so that rounding errors grow with its length, not the capture's; the
  // picture's sums stay in memory, for registers that are kept over this loop cost more than they save.
  for (uint b = 0; b < launch.block_count; ++b) {
    const BlockEntry of_host = blocks[b];
    Entry entry;
    entry.is_start = launch.is_first && b == 0;
    entry.is_kept = of_host.sample_count == 0;
    entry.kept = of_host.kept_bits;
    entry.kept_at = of_host.payload_offset;
    entry.payload = chunk + (entry.is_kept ? 0 : of_host.payload_offset);
    entry.parts = parts + of_host.part_row * launch.function_count;
    entry.gains = gains + of_host.part_row * launch.function_count;
    entry.block.sample_count = of_host.sample_count;
    entry.block.function_count = launch.function_count;
    entry.block.first_row = of_host.table_row % NUTIK_TABLE_ROWS;
    entry.block.weights = weights + (of_host.table_row - entry.block.first_row) * launch.function_count;
    entry.block.boundaries = boundaries + of_host.table_row * launch.function_count;

    for (size_t in_band = item.first_tile; in_band < item.last_tile; ++in_band) {
      const Tile tile = {in_band, tiles[in_band], item.lane};
      global const function_index* functions = function_of_lane + in_band * NUTIK_TILE_PIXELS + item.lane;
#if NUTIK_ITEM_PIXELS == 1
      const uint function = functions[0];
#else
      const uint function = function_of_tile[in_band];
      if (function == NUTIK_MIXED_FUNCTIONS) {
        expose_several(&entry, tile, functions, transfer, band);
        continue;
      }
#endif
      if (exposes[function]) expose_one(&entry, tile, function, transfer, band);
    }
  }
}
