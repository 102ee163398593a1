// Reports the sizes and offsets of the layouts that host and kernels share, as this device's compiler
// sees them. Run by the tests.
#include "layout.clh"

#define NUTIK_OFFSET(type, member) ((uint)(size_t)(&((private type*)0)->member))

kernel void layout_probe(global uint* restrict sizes) {
  uint i = 0;
  sizes[i++] = sizeof(TileEntry);
  sizes[i++] = NUTIK_OFFSET(TileEntry, offset);
  sizes[i++] = NUTIK_OFFSET(TileEntry, count);
  sizes[i++] = sizeof(BlockPart);
  sizes[i++] = NUTIK_OFFSET(BlockPart, first);
  sizes[i++] = NUTIK_OFFSET(BlockPart, last);
  sizes[i++] = NUTIK_OFFSET(BlockPart, bits);
  sizes[i++] = sizeof(BlockEntry);
  sizes[i++] = NUTIK_OFFSET(BlockEntry, payload_offset);
  sizes[i++] = NUTIK_OFFSET(BlockEntry, table_row);
  sizes[i++] = NUTIK_OFFSET(BlockEntry, part_row);
  sizes[i++] = NUTIK_OFFSET(BlockEntry, sample_count);
  sizes[i++] = NUTIK_OFFSET(BlockEntry, kept_bits);
  sizes[i++] = sizeof(ExposeLaunch);
  sizes[i++] = NUTIK_OFFSET(ExposeLaunch, tile_count);
  sizes[i++] = NUTIK_OFFSET(ExposeLaunch, block_count);
  sizes[i++] = NUTIK_OFFSET(ExposeLaunch, function_count);
  sizes[i++] = NUTIK_OFFSET(ExposeLaunch, is_first);
  sizes[i++] = NUTIK_TILE_PIXELS;
  sizes[i++] = NUTIK_BODY_UNIT;
  sizes[i++] = NUTIK_RECORDS_FLAG;
  sizes[i++] = NUTIK_MIXED_FUNCTIONS;
  sizes[i++] = NUTIK_STEADY;
  sizes[i++] = NUTIK_IN_BUNDLE;
  sizes[i++] = NUTIK_BUNDLE_START;
  sizes[i++] = NUTIK_BUNDLE_END;
  sizes[i++] = NUTIK_SUM_SHIFT;
}
