// Reports the sizes and offsets of the layouts that host and kernels share, as this device's compiler
// sees them. Run by the tests.
#include "layout.clh"

#define NUTIK_OFFSET(type, member) ((uint)(size_t)(&((private type*)0)->member))

kernel void layout_probe(global uint* restrict sizes) {
  uint i = 0;
  sizes[i++] = sizeof(TileEntry);
  sizes[i++] = NUTIK_OFFSET(TileEntry, offset);
  sizes[i++] = NUTIK_OFFSET(TileEntry, count);
  sizes[i++] = sizeof(SampleSpan);
  sizes[i++] = NUTIK_OFFSET(SampleSpan, first);
  sizes[i++] = NUTIK_OFFSET(SampleSpan, last);
  sizes[i++] = sizeof(BlockEntry);
  sizes[i++] = NUTIK_OFFSET(BlockEntry, payload_offset);
  sizes[i++] = NUTIK_OFFSET(BlockEntry, table_row);
  sizes[i++] = NUTIK_OFFSET(BlockEntry, span_row);
  sizes[i++] = NUTIK_OFFSET(BlockEntry, sample_count);
  sizes[i++] = NUTIK_TILE_PIXELS;
  sizes[i++] = NUTIK_BODY_UNIT;
  sizes[i++] = NUTIK_RECORDS_FLAG;
  sizes[i++] = NUTIK_MIXED_FUNCTIONS;
}
