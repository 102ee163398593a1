// Exposes pixels: the integral of light times gain, from change records and boundary tables.
//
//   in:    a chunk of blocks (layout: host/imev/block.hpp), the packed tables; of a band of the picture its tiles, each
//          with its number in the picture, and each pixel's function. A tile whose pixels several functions share is
//          there once for each of them
//   out:   sums [tile][channel][plane][64]: Σ_k v_k w_k so far, in scaled gain; added to what is there,
//          or stored where `first` is set
//   items: see items.clh
#include "items.clh"
#include "tiles.clh"

// Adds a block's sums to the picture's, which start with the first block.
NUTIK_INLINE void add_sums(global Sum* restrict sums, const size_t tile, const uint lane,
                           const Sums* block_sums, const bool is_start) {
#pragma unroll
  for (uint channel = 0; channel < NUTIK_CHANNELS; ++channel) {
#pragma unroll
    for (uint group = 0; group < NUTIK_GROUPS; ++group) {
      global Sum* to = sums + sums_at(tile, NUTIK_CHANNELS, channel, lane + group * NUTIK_LANES);
      const Sums sum = block_sums[channel * NUTIK_GROUPS + group];
      store_sums(is_start ? sum : add(load_sums(to), sum), to);
    }
  }
}

kernel void expose(global const uchar* restrict chunk, global const BlockEntry* restrict blocks,
                   const uint block_count, global const SampleSpan* restrict spans,
                   global const Weight* restrict weights, global const Weight* restrict boundaries,
                   const uint function_count, global const uint* restrict tiles,
                   global const ushort* restrict function_of_tile,
                   global const uchar* restrict function_of_lane,
                   global const Light* restrict transfer, global Sum* restrict sums,
                   const ulong tile_count, const uint first) {
  const Item item = item_of(get_global_id(0), tile_count);
  const uint lane = item.lane;

  // Block by block, not tile by tile: a block's tiles lie one after the other in memory. A block is summed
  // on its own before it is added, so that rounding errors grow with its length, not the capture's; the
  // picture's sums stay in memory, for registers that are kept over this loop cost more than they save.
  for (uint b = 0; b < block_count; ++b) {
    const BlockEntry entry = blocks[b];
    const bool is_start = first && b == 0;
    global const uchar* payload = chunk + entry.payload_offset;
    global const TileEntry* directory = (global const TileEntry*)payload;
    global const SampleSpan* block_spans = spans + entry.span_row * function_count;
    Block block;
    block.sample_count = entry.sample_count;
    block.function_count = function_count;
    block.weights = weights + entry.table_row * function_count;
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
      Sums sums_of_block[NUTIK_ITEM_VECTORS];
#pragma unroll
      for (uint i = 0; i < NUTIK_ITEM_VECTORS; ++i) sums_of_block[i] = zero();
      // Written twice so that the compiler sees which one it compiles.
      if (region.is_uniform) {
        region.is_uniform = true;
        block.first = block_spans[region.function].first;
        block.last = block_spans[region.function].last;
        if (block.first < block.last) {
          expose_tile(payload, directory[tiles[tile]], lane, &block, &region, transfer, sums_of_block);
        } else if (!is_start) {
          continue;
        }
      } else {
        region.is_uniform = false;
        block.first = 0;
        block.last = entry.sample_count;
        region.functions = function_of_lane + tile * NUTIK_TILE_PIXELS + lane;
        expose_tile(payload, directory[tiles[tile]], lane, &block, &region, transfer, sums_of_block);
      }
      add_sums(sums, tile, lane, sums_of_block, is_start);
    }
  }
}
