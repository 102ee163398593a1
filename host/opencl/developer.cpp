#include "opencl/developer.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "opencl/kernel_numbers.hpp"
#include "opencl/opencl_api.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

using DevelopSumsKernel = cl::KernelFunctor<cl::Buffer, cl_uint, cl_uint, cl_ulong, cl::Buffer>;
using DevelopCodesKernel = cl::KernelFunctor<cl::Buffer, cl::Buffer, cl::Buffer, cl_uint, cl_uint, cl_ulong, cl::Buffer,
                                             cl::Buffer, cl_uint, cl::Buffer>;

using BlendCodesKernel =
    cl::KernelFunctor<cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer, cl_uint, cl_uint, cl_uint,
                      cl_ulong, cl::Buffer, cl::Buffer, cl_uint, cl::Buffer>;

using CountSaturatedKernel = cl::KernelFunctor<cl::Buffer, cl::Buffer, cl::Buffer, cl_uint, cl_uint, cl_ulong, cl_uint,
                                               cl_uint, cl_uint, cl_uint, cl::Buffer, cl::Buffer>;

// Sums that are developed at a time where they become light. So many rows of tiles begin where devices let a part of a
// buffer begin: at a multiple of 4096 bytes.
constexpr std::uint64_t kPartBytes = 4 << 20;
constexpr std::uint32_t kPartRows = 16;

// The first of some rows of a band, counted in it.
std::uint64_t first_tile_of(const Band& band, const Band& rows) {
  return std::uint64_t{(rows.first_row - band.first_row) / kTileSide} * band.columns;
}

// Whether a value has the first code or the last.
bool has_end_code(std::span<const std::byte> codes, ValueType type, std::uint32_t white_code) {
  const auto is_end = [&](std::uint32_t code) { return code == 0 || code == white_code; };
  if (type == ValueType::code8) {
    return std::ranges::any_of(codes, is_end, [](std::byte code) { return std::to_integer<std::uint32_t>(code); });
  }
  const std::span wide(reinterpret_cast<const std::uint16_t*>(codes.data()), codes.size() / 2);
  return std::ranges::any_of(wide, is_end);
}

double sum_at(std::span<const std::byte> raster, Precision precision, std::uint64_t value) {
  const auto read = [&]<typename T>(T number) {
    std::memcpy(&number, raster.data() + value * sizeof number, sizeof number);
    return number;
  };
  switch (precision) {
    case Precision::single_: return read(float{});
    case Precision::compensated: return value_of(read(FloatPair{}));
    case Precision::double_: return read(double{});
    case Precision::fixed: return static_cast<double>(read(std::int64_t{}));
  }
  return 0.0;
}

// Value `at` of the first plane of sums by tiles, whose planes lie one behind the other.
double tile_sum(std::span<const std::byte> sums, Precision precision, std::uint64_t at) {
  if (precision != Precision::compensated) return sum_at(sums, precision, at);
  return sum_at(sums, Precision::single_, at) + sum_at(sums, Precision::single_, at + kTilePixels);
}

template <typename Value>
void store_as(const RenderPlan& plan, const Rectangle& rectangle, Precision precision,
              std::span<const std::byte> raster, std::span<Value> values) {
  const std::vector<LightFactors> factors = light_factors(plan, precision);
  const std::uint32_t channels = plan.capture.shape.channels;
  parallel_for(rectangle.height, [&](std::uint64_t row) {
    const std::uint64_t first_pixel = (rectangle.y + row) * plan.capture.shape.width + rectangle.x;
    std::uint64_t i = row * rectangle.width * channels;
    for (std::uint32_t column = 0; column < rectangle.width; ++column) {
      const LightFactors& light = factors[plan.map->region_at(first_pixel + column)];
      for (std::uint32_t channel = 0; channel < channels; ++channel, ++i) {
        values[i] = static_cast<Value>(sum_at(raster, precision, i) * light.factor * light.exponent.first *
                                       light.exponent.second);
      }
    }
  });
}

// Tiles [first, last) of a band.
struct TilesOfBand {
  std::size_t first;
  std::size_t last;
};

template <typename Value>
void blend_as(const RenderPlan& plan, const FunctionMap& map, const TilesOfBand& tiles, Precision precision,
              std::span<const std::byte> sums, const Rectangle& part, std::span<Value> values) {
  constexpr std::size_t kTilesAtOnce = 64;
  const std::vector<LightFactors> factors = light_factors(plan, precision);
  const std::uint32_t channels = plan.capture.shape.channels;
  const std::uint32_t plane_values = (precision == Precision::compensated ? 2 : 1) * kTilePixels;
  const TileGrid grid(plan.capture.shape);
  const std::uint32_t first_sums = map.first_of[tiles.first];
  // A channel of a pixel, from the sums of one function.
  const auto light_of = [&](std::uint32_t tile, std::uint32_t lane, std::uint32_t channel) {
    const LightFactors& light = factors[map.of_lane[std::size_t{tile} * kTilePixels + lane]];
    const std::uint64_t at = (std::uint64_t{tile - first_sums} * channels + channel) * plane_values + lane;
    return tile_sum(sums, precision, at) * light.factor * light.exponent.first * light.exponent.second;
  };
  const auto blended = [&](std::uint32_t first, std::uint32_t last, std::uint32_t lane, std::uint32_t channel) {
    if (last == first + 1) return light_of(first, lane, channel);
    double sum = 0.0;
    for (std::uint32_t tile = first; tile < last; ++tile) {
      const std::uint16_t share = map.shares[std::size_t{tile} * kTilePixels + lane];
      if (share == kWholeShare) return light_of(tile, lane, channel);
      if (share != 0) sum += share * light_of(tile, lane, channel);
    }
    return sum / kWholeShare;
  };
  parallel_for_parts(tiles.last - tiles.first, kTilesAtOnce, [&](std::uint64_t from, std::uint64_t to) {
    for (std::size_t tile = tiles.first + from; tile < tiles.first + to; ++tile) {
      const std::uint32_t first = map.first_of[tile], last = map.first_of[tile + 1];
      const std::uint32_t left = map.tiles[first] % grid.columns() * kTileSide;
      const std::uint32_t top = map.tiles[first] / grid.columns() * kTileSide;
      for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
        const std::uint32_t x = left + lane % kTileSide - part.x, y = top + lane / kTileSide - part.y;
        if (x >= part.width || y >= part.height) continue;  // unsigned: also what lies before it
        Value* const pixel = &values[(std::uint64_t{y} * part.width + x) * channels];
        for (std::uint32_t channel = 0; channel < channels; ++channel) {
          pixel[channel] = static_cast<Value>(blended(first, last, lane, channel));
        }
      }
    }
  });
}

// The light of `raster`, sums [pixel][channel][plane] of a rectangle as develop_sums writes them, into a picture of
// light32 or light64: in double, so that it is the same for every device.
void store_light(const RenderPlan& plan, const Rectangle& rectangle, Precision precision,
                 std::span<const std::byte> raster, Picture& picture) {
  if (picture.type == ValueType::light32) {
    store_as(plan, rectangle, precision, raster, picture.values<float>());
  } else {
    store_as(plan, rectangle, precision, raster, picture.values<double>());
  }
}

// The light of what `part` of the picture has of some tiles, from their sums as expose.cl writes them: of a mixed pixel
// by its shares. In double, as above.
void blend_light(const RenderPlan& plan, const FunctionMap& map, const TilesOfBand& tiles, Precision precision,
                 std::span<const std::byte> sums, const Rectangle& part, Picture& picture) {
  if (picture.type == ValueType::light32) {
    blend_as(plan, map, tiles, precision, sums, part, picture.values<float>());
  } else {
    blend_as(plan, map, tiles, precision, sums, part, picture.values<double>());
  }
}

}  // namespace

void Developer::develop(const ExposedBand& exposed) {
  if (holds_codes(output_.type)) return make_counted_codes(exposed);
  for_each_part(exposed, output_.type, [&](const Rectangle& part, const Picture& of_part) {
    std::ranges::copy(of_part.bytes, rows_of(part).begin());
  });
}

// Codes, and how many pixels saturate. The kernels know neither negative codes nor primaries, and do not count what is
// blended: where these are asked for, codes lie too close together to be searched, or mixed pixels can saturate, the
// sums are read and turned into light here.
void Developer::make_counted_codes(const ExposedBand& exposed) {
  const CodeMaking making = CodeMaking::of(plan_.capture, output_);
  const CodeScale scale(making.transfer, output_);
  const DeviceMemory::Scope scope(memory_);
  const DeviceCodes* const tables = kernels_make_codes(plan_.capture, output_)
                                        ? lookups_.codes(CodeKey::of(plan_, work_.precision, output_), memory_)
                                        : nullptr;
  if (tables != nullptr) {
    make_codes(exposed, *tables);
    const auto of_band = rows_of(part_in(exposed.band));
    if (!can_saturate(plan_, making, scale) || !has_end_code(of_band, output_.type, output_.white_code)) return;
    if (!exposed.map.host->is_mixed()) {
      saturation_ += saturated(exposed, scale);
      return;
    }
  }
  for_each_part(exposed, ValueType::light64, [&](const Rectangle& part, Picture& seen) {
    to_shown_light(seen, making);
    saturation_ += count_saturated(seen, scale);
    if (tables == nullptr) std::ranges::copy(encoded(seen, scale, output_).bytes, rows_of(part).begin());
  });
}

// Calls visit(part, its light) for a band's parts from top to bottom. Light takes up to six times what codes do: a part
// at a time, it takes next to nothing.
template <typename Visit>
void Developer::for_each_part(const ExposedBand& exposed, ValueType type, Visit visit) {
  const std::uint64_t row_bytes = sums_bytes(exposed.band.columns, shape_.channels, work_.precision);
  const auto all_rows = static_cast<std::uint32_t>(exposed.band.tile_count / exposed.band.columns);
  const auto rows_at_once =
      static_cast<std::uint32_t>(std::max<std::uint64_t>(1, kPartBytes / row_bytes / kPartRows) * kPartRows);
  for (std::uint32_t row = 0; row < all_rows; row += rows_at_once) {
    const std::uint32_t rows = std::min(rows_at_once, all_rows - row);
    Band band = exposed.band;
    band.tile_count = std::uint64_t{rows} * band.columns;
    band.first_row += row * kTileSide;
    band.shape.height = std::min(rows * kTileSide, exposed.band.shape.height - row * kTileSide);
    const Rectangle part = part_in(band);
    Picture picture({part.width, part.height, shape_.channels}, type, output_.white_code);
    if (exposed.map.host->is_mixed()) {
      blend_rows(exposed, band, part, picture);
    } else {
      develop_rows(exposed, band, part, picture);
    }
    visit(part, picture);
  }
}

// The light of some rows of tiles of a band: sums become a raster on the device, and light here.
void Developer::develop_rows(const ExposedBand& exposed, const Band& rows, const Rectangle& part, Picture& picture) {
  DevelopSumsKernel kernel(program_, "develop_sums");
  const std::uint64_t tile_bytes = sums_bytes(1, shape_.channels, work_.precision);
  const std::uint64_t first_tile = first_tile_of(exposed.band, rows);
  cl::Buffer sums = exposed.sums;
  cl_buffer_region region{first_tile * tile_bytes, rows.tile_count * tile_bytes};
  if (rows.tile_count < exposed.band.tile_count) {
    sums = sums.createSubBuffer(CL_MEM_READ_ONLY, CL_BUFFER_CREATE_TYPE_REGION, &region);
  }
  Bytes of_sums(std::uint64_t{part.width} * part.height * shape_.channels * sum_bytes(work_.precision));
  develop_band(rows, part, of_sums, [&](const cl::Buffer& raster) {
    return kernel(items(kernel, queue_, work_.shape, rows.tile_count), sums, rows.shape.width, rows.shape.height,
                  rows.tile_count, raster);
  });
  store_light(plan_, part, work_.precision, of_sums, picture);
}

// The same where tiles are mixed: what comes from the device are sums of tiles.
void Developer::blend_rows(const ExposedBand& exposed, const Band& rows, const Rectangle& part, Picture& picture) {
  const FunctionMap& map = *exposed.map.host;
  const std::uint64_t first_tile = first_tile_of(exposed.band, rows);
  const TilesOfBand tiles{first_tile, first_tile + rows.tile_count};
  const std::uint64_t tile_bytes = sums_bytes(1, shape_.channels, work_.precision);
  const std::uint64_t first = map.first_of[tiles.first], last = map.first_of[tiles.last];
  Bytes sums((last - first) * tile_bytes);
  queue_.enqueueReadBuffer(exposed.sums, CL_TRUE, first * tile_bytes, sums.size(), sums.data());
  blend_light(plan_, map, tiles, work_.precision, sums, part, picture);
}

void Developer::make_codes(const ExposedBand& exposed, const DeviceCodes& tables) {
  const cl::Buffer scales = memory_.upload(light_scales(plan_, work_.precision));
  const Band& band = exposed.band;
  const Rectangle part = part_in(band);
  if (exposed.map.host->is_mixed()) {
    BlendCodesKernel kernel(program_, "blend_codes");
    const cl::Buffer where_blended = memory_.upload(blend_scales(plan_, work_.precision));
    develop_band(band, part, rows_of(part), [&](const cl::Buffer& raster) {
      return kernel(items(kernel, queue_, work_.shape, band.tile_count), exposed.sums, scales, where_blended,
                    exposed.map.of_lane, exposed.map.first_of, exposed.map.shares, blend_shift(plan_, work_.precision),
                    band.shape.width, band.shape.height, band.tile_count, tables.thresholds, tables.guesses,
                    tables.guess_count, raster);
    });
    return;
  }
  DevelopCodesKernel kernel(program_, "develop_codes");
  develop_band(band, part, rows_of(part), [&](const cl::Buffer& raster) {
    return kernel(items(kernel, queue_, work_.shape, band.tile_count), exposed.sums, scales, exposed.map.of_lane,
                  band.shape.width, band.shape.height, band.tile_count, tables.thresholds, tables.guesses,
                  tables.guess_count, raster);
  });
}

Saturation Developer::saturated(const ExposedBand& exposed, const CodeScale& scale) {
  const DeviceMemory::Scope scope(memory_);
  const Band& band = exposed.band;
  const Rectangle part = part_in(band);
  const std::uint32_t left = part.x - band.first_column, top = part.y - band.first_row;
  const cl::Buffer limits = memory_.upload(code_limits(CodeKey::of(plan_, work_.precision, output_), scale, plan_));
  std::array<cl_uint, 2> found{};
  const cl::Buffer counts = memory_.allocate(sizeof found, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, found.data());
  CountSaturatedKernel kernel(program_, "count_saturated");
  const cl::Event event =
      kernel(items(kernel, queue_, work_.shape, band.tile_count), exposed.sums,
             memory_.upload(blend_scales(plan_, work_.precision)), exposed.map.of_lane, band.shape.width,
             band.shape.height, band.tile_count, left, top, left + part.width, top + part.height, limits, counts);
  queue_.enqueueReadBuffer(counts, CL_TRUE, 0, sizeof found, found.data());
  develop_ms_ += milliseconds(event).value_or(0.0);
  return {found[0], found[1]};
}

// Where a part, which has the rectangle's width, lies in its picture.
std::span<std::byte> Developer::rows_of(const Rectangle& part) {
  const std::uint64_t row_bytes = picture_.bytes.size() / shape_.height;
  return std::span(picture_.bytes).subspan((part.y - rectangle_.y) * row_bytes, part.height * row_bytes);
}

// What a band and the rectangle have in common.
Rectangle Developer::part_in(const Band& band) const {
  const std::uint32_t top = std::max(band.first_row, rectangle_.y);
  const std::uint32_t bottom = std::min(band.first_row + band.shape.height, rectangle_.y + rectangle_.height);
  return {rectangle_.x, top, rectangle_.width, bottom - top};
}

// Has `launch` fill a band's own raster, and copies what belongs to a part of the rectangle to that part's.
template <typename Launch>
void Developer::develop_band(const Band& band, const Rectangle& part, std::span<std::byte> raster, Launch launch) {
  const DeviceMemory::Scope scope(memory_);
  const std::uint64_t pixel_bytes = raster.size() / part.width / part.height;
  const cl::Buffer of_band = memory_.allocate(band.shape.pixel_count() * pixel_bytes, CL_MEM_WRITE_ONLY);
  const cl::Event event = launch(of_band);
  read_band(of_band, band, part, raster);
  develop_ms_ += milliseconds(event).value_or(0.0);
}

void Developer::read_band(const cl::Buffer& of_band, const Band& band, const Rectangle& part,
                          std::span<std::byte> raster) {
  const std::uint64_t pixel_bytes = raster.size() / part.width / part.height;
  const std::uint64_t band_row = band.shape.width * pixel_bytes;
  const std::uint64_t row = part.width * pixel_bytes;
  if (row == band_row) {
    queue_.enqueueReadBuffer(of_band, CL_TRUE, (part.y - band.first_row) * row, raster.size(), raster.data());
    return;
  }
  const cl::array<cl::size_type, 3> from{(part.x - band.first_column) * pixel_bytes, part.y - band.first_row, 0};
  queue_.enqueueReadBufferRect(of_band, CL_TRUE, from, {0, 0, 0}, {row, part.height, 1}, band_row, 0, row, 0,
                               raster.data());
}

}  // namespace nutik
