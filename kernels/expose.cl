// Exposes pixels: the integral of light times gain, from change records and boundary tables.
//
//   in:      a chunk of blocks (layout: host/imev/block.hpp), the packed tables; of a band of the picture its tiles, each
//          with its number in the picture, and each pixel's function. A tile whose pixels several functions share is
//          there once for each of them. By function, whether it is exposed: of others the sums are there. Sums of blocks,
//          halves and bundles that were made before: [kept][tile][channel][plane][64]
//   out:   sums [tile][channel][plane][64]: Σ_k v_k w_k so far, in scaled gain; added to what is there,
//          or stored where `first` is set. Those of bundles so far, likewise
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

kernel void expose(global const uchar* restrict chunk, global const BlockEntry* restrict blocks,
                   const uint block_count, global const BlockPart* restrict parts,
                   global const Weight* restrict gains, global const Weight* restrict weights,
                   global const Weight* restrict boundaries, const uint function_count,
                   global const uint* restrict tiles, global const ushort* restrict function_of_tile,
                   global const function_index* restrict function_of_lane, global const uchar* restrict exposes,
                   global const Light* restrict transfer, global const Sum* restrict kept,
                   global Sum* restrict bundles, global Sum* restrict sums,
                   const ulong tile_count, const uint first) {
  const Item item = item_of(get_global_id(0), tile_count);
  const uint lane = item.lane;

  // Block by block, not tile by tile: a block's tiles lie one after the other in memory. A block is summed
  // on its own before it is added, so that rounding errors grow with its length, not the capture's; the
  // picture's sums stay in memory, for registers that are kept over this loop cost more than they save.
  for (uint b = 0; b < block_count; ++b) {
    const BlockEntry entry = blocks[b];
    const bool is_start = first && b == 0;
    const bool is_kept = entry.sample_count == 0;
    global const uchar* payload = chunk + (is_kept ? 0 : entry.payload_offset);
    global const TileEntry* directory = (global const TileEntry*)payload;
    global const BlockPart* block_parts = parts + entry.part_row * function_count;
    global const Weight* block_gains = gains + entry.part_row * function_count;
    Block block;
    block.sample_count = entry.sample_count;
    block.function_count = function_count;
    block.first_row = entry.table_row % NUTIK_TABLE_ROWS;
    block.weights = weights + (entry.table_row - block.first_row) * function_count;
    block.boundaries = boundaries + entry.table_row * function_count;

    for (size_t tile = item.first_tile; tile < item.last_tile; ++tile) {
      Region region;
#if NUTIK_ITEM_PIXELS == 1
      region.is_uniform = true;
      region.function = function_of_lane[tile * NUTIK_TILE_PIXELS + lane];
#else
      region.function = function_of_tile[tile];
      region.is_uniform = region.function != NUTIK_MIXED_FUNCTIONS;
#endif
      if (region.is_uniform && !exposes[region.function]) continue;
      Sums sums_of_block[NUTIK_ITEM_VECTORS];
      clear(sums_of_block);
      // Written twice so that the compiler sees which one it compiles.
      if (region.is_uniform) {
        region.is_uniform = true;
        const BlockPart part = block_parts[region.function];
        const uint kept_as = part.steady ? 1u << (part.steady >> NUTIK_SUM_SHIFT) : 0;
        const bool is_of_kept = entry.kept & kept_as;
        bool adds = part.first < part.last && is_kept == is_of_kept;
        if (adds && is_kept) {
          load_tile(kept + entry.payload_offset, tiles[tile], lane, sums_of_block);
        } else if (adds) {
          block.first = part.first;
          block.last = part.last;
          expose_tile(payload, directory[tiles[tile]], lane, &block, &region, transfer, sums_of_block);
          if (part.steady & NUTIK_IN_BUNDLE) {
            add_sums(bundles, tile, lane, sums_of_block, part.steady & NUTIK_BUNDLE_START);
            adds = part.steady & NUTIK_BUNDLE_END;
            if (adds) load_tile(bundles, tile, lane, sums_of_block);
            else clear(sums_of_block);
          }
        }
        if (!adds && !is_start) continue;
        if (part.steady) scale(block_gains[region.function], sums_of_block);
      } else {
        if (is_kept && !is_start) continue;
        if (!is_kept) {
          region.is_uniform = false;
          block.first = 0;
          block.last = entry.sample_count;
          region.functions = function_of_lane + tile * NUTIK_TILE_PIXELS + lane;
#if NUTIK_FUNCTION_BYTES == 2
          narrow(&block, block_parts, region.functions);
          if (block.first >= block.last) {
            if (is_start) add_sums(sums, tile, lane, sums_of_block, is_start);
            continue;
          }
#endif
          expose_tile(payload, directory[tiles[tile]], lane, &block, &region, transfer, sums_of_block);
          scale_each(block_gains, region.functions, sums_of_block);
        }
      }
      add_sums(sums, tile, lane, sums_of_block, is_start);
    }
  }
}
