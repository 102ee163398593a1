#include "opencl/developer.hpp"

#include <algorithm>

#include "opencl/kernel_tables.hpp"
#include "opencl/launch.hpp"

namespace nutik {
namespace {

using DevelopSumsKernel = cl::KernelFunctor<cl::Buffer, cl_uint, cl_uint, cl_ulong, cl::Buffer>;
using DevelopCodesKernel = cl::KernelFunctor<cl::Buffer, cl::Buffer, cl::Buffer, cl_uint, cl_uint, cl_ulong,
                                             cl::Buffer, cl::Buffer, cl_uint, cl::Buffer>;

// Whether a value has the first code or the last.
bool has_end_code(const Picture& codes) {
  const auto is_end = [&](std::uint32_t code) { return code == 0 || code == codes.white_code; };
  return codes.type == ValueType::code8 ? std::ranges::any_of(codes.values<std::uint8_t>(), is_end)
                                        : std::ranges::any_of(codes.values<std::uint16_t>(), is_end);
}

}  // namespace

Picture Developer::develop(std::span<const ExposedBand> bands) {
  return holds_codes(output_.type) ? counted_codes(bands) : light(bands, output_.type);
}

// Codes, and how many pixels saturate. The kernel knows no negative codes and counts nothing: where a plan's
// functions can saturate, or negative light is to be seen, the sums are read and turned into light here.
Picture Developer::counted_codes(std::span<const ExposedBand> bands) {
  const CodeScale scale(plan_.capture.transfer, output_);
  if (output_.negative != NegativeLight::saturate) {
    const Picture seen = light(bands, ValueType::light64);
    saturation_ = count_saturated(seen, scale);
    return encoded(seen, scale, output_);
  }
  Picture picture = codes(bands);
  if (can_saturate(plan_, scale) && has_end_code(picture)) {
    saturation_ = count_saturated(light(bands, ValueType::light64), scale);
  }
  return picture;
}

// As light of this type, for a picture that will be stored as the output says.
Picture Developer::light(std::span<const ExposedBand> bands, ValueType type) {
  Bytes of_sums(shape_.value_count() * sum_bytes(work_.precision));
  DevelopSumsKernel kernel(program_, "develop_sums");
  for (const ExposedBand& exposed : bands) {
    const Band& band = exposed.band;
    develop_band(band, of_sums, [&](const cl::Buffer& raster) {
      return kernel(items(queue_, work_.shape, band.tile_count), exposed.sums, band.shape.width,
                    band.shape.height, band.tile_count, raster);
    });
  }
  Picture picture(shape_, type, output_.white_code);
  store_light(plan_, rectangle_, work_.precision, of_sums, picture);
  return picture;
}

Picture Developer::codes(std::span<const ExposedBand> bands) {
  const DeviceMemory::Scope scope(memory_);
  const DeviceCodes& tables =
      constants_.codes(CodeKey::of(plan_, work_.precision, output_.white_code), memory_);
  const cl::Buffer scales = memory_.upload(light_scales(plan_, work_.precision));
  Picture picture(shape_, output_.type, output_.white_code);
  DevelopCodesKernel kernel(program_, "develop_codes");
  for (const ExposedBand& exposed : bands) {
    const Band& band = exposed.band;
    develop_band(band, picture.bytes, [&](const cl::Buffer& raster) {
      return kernel(items(queue_, work_.shape, band.tile_count), exposed.sums, scales,
                    exposed.function_of_lane, band.shape.width, band.shape.height, band.tile_count,
                    tables.thresholds, tables.guesses, tables.guess_count, raster);
    });
  }
  return picture;
}

// Has `launch` fill a band's own raster, and copies what belongs to the rectangle to where it lies there.
template <typename Launch>
void Developer::develop_band(const Band& band, std::span<std::byte> raster, Launch launch) {
  const DeviceMemory::Scope scope(memory_);
  const std::uint64_t pixel_bytes = raster.size() / shape_.pixel_count();
  const cl::Buffer of_band = memory_.allocate(band.shape.pixel_count() * pixel_bytes, CL_MEM_WRITE_ONLY);
  const cl::Event event = launch(of_band);
  read_band(of_band, band, raster);
  develop_ms_ += milliseconds(event).value_or(0.0);
}

void Developer::read_band(const cl::Buffer& of_band, const Band& band, std::span<std::byte> raster) {
  const std::uint64_t pixel_bytes = raster.size() / shape_.pixel_count();
  const std::uint32_t top = std::max(band.first_row, rectangle_.y);
  const std::uint32_t bottom = std::min(band.first_row + band.shape.height, rectangle_.y + rectangle_.height);
  const std::uint64_t band_row = band.shape.width * pixel_bytes;
  const std::uint64_t row = rectangle_.width * pixel_bytes;
  std::byte* to = raster.data() + (top - rectangle_.y) * row;
  if (row == band_row) {
    queue_.enqueueReadBuffer(of_band, CL_TRUE, (top - band.first_row) * row, (bottom - top) * row, to);
    return;
  }
  const cl::array<cl::size_type, 3> from{(rectangle_.x - band.first_column) * pixel_bytes,
                                         top - band.first_row, 0};
  queue_.enqueueReadBufferRect(of_band, CL_TRUE, from, {0, 0, 0}, {row, bottom - top, 1}, band_row, 0, row, 0,
                               to);
}

}  // namespace nutik
