#include "opencl/build_options.hpp"

#include <algorithm>
#include <string_view>

#include "capture/format.hpp"

namespace nutik {
namespace {

const char* kernel_name_of(Precision precision) {
  switch (precision) {
    case Precision::single_: return "NUTIK_SINGLE";
    case Precision::compensated: return "NUTIK_COMPENSATED";
    case Precision::double_: return "NUTIK_DOUBLE";
    case Precision::fixed: return "NUTIK_FIXED";
  }
  return "";
}

// -w: drivers print how many warnings they counted, in their own headers too. tools/check_kernels looks at ours.
std::string common_options(const Work& work, const CaptureFormat& capture, bool has_delays) {
  return format(
      "-w -cl-std=CL1.2 -DNUTIK_PRECISION={} -DNUTIK_HAS_FMA={} -DNUTIK_CHANNELS={} -DNUTIK_FUNCTION_BYTES={}",
      kernel_name_of(work.precision), work.has_fma ? 1 : 0, capture.shape.channels, has_delays ? 2 : 1);
}

}  // namespace

std::string expose_options(const Work& work, const CaptureFormat& capture, const char* light_kind, bool has_delays,
                           bool has_byte_tables) {
  const bool has_copies = capture.code_bytes == 1 && light_kind == std::string_view("NUTIK_LIGHT_TABLE");
  return format(
      "{} -DNUTIK_CODE_BYTES={} -DNUTIK_LIGHT={} -DNUTIK_ITEM_PIXELS={} -DNUTIK_ITEM_TILES={} "
      "-DNUTIK_LANES={} -DNUTIK_ROWS_AT_ONCE={} -DNUTIK_TABLE_COPIES={} -DNUTIK_BYTE_TABLES={}",
      common_options(work, capture, has_delays), capture.code_bytes, light_kind, work.shape.item_pixels,
      work.shape.item_tiles, work.shape.lanes, work.shape.rows_at_once, has_copies ? work.shape.table_copies : 0,
      has_byte_tables ? 1 : 0);
}

std::string develop_options(const Work& work, const CaptureFormat& capture, const OutputFormat& output, bool blends,
                            bool has_delays) {
  const std::size_t raster_bytes = holds_codes(output.type) ? value_bytes(output.type) : 1;
  return format(
      "{} -DNUTIK_ITEM_PIXELS={} -DNUTIK_ITEM_TILES={} -DNUTIK_LANES={} "
      "-DNUTIK_TABLE_COPIES=0 -DNUTIK_RASTER_BYTES={} -DNUTIK_BLENDS={}",
      common_options(work, capture, has_delays), work.shape.item_pixels, work.shape.item_tiles,
      std::min(work.shape.lanes, kTileSide), raster_bytes, blends ? 1 : 0);
}

}  // namespace nutik
