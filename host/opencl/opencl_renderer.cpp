#include "opencl/opencl_renderer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "opencl/code_search.hpp"
#include "opencl/function_map.hpp"
#include "opencl/kernel_layout.hpp"
#include "opencl/kernel_sources.hpp"
#include "opencl/light_pieces.hpp"
#include "opencl/light_source.hpp"
#include "opencl/opencl_api.hpp"
#include "opencl/program_store.hpp"
#include "opencl/work_shape.hpp"
#include "system/page_buffer.hpp"

namespace nutik {

Precision parse_precision(std::string_view text) {
  if (text == "single") return Precision::single_;
  if (text == "double") return Precision::double_;
  throw UsageError(format("precision '{}' is not known; choose single or double", text));
}

std::string to_text(Precision precision) { return precision == Precision::single_ ? "single" : "double"; }

namespace {

constexpr std::uint64_t kDefaultChunkBytes = 1ull << 30;
constexpr std::uint64_t kPageBytes = 4096;

using ExposeKernel =
    cl::KernelFunctor<cl::Buffer, cl::Buffer, cl_uint, cl::Buffer, cl::Buffer, cl::Buffer, cl_uint,
                      cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer, cl_ulong, cl_uint>;
using DevelopLightKernel =
    cl::KernelFunctor<cl::Buffer, cl::Buffer, cl::Buffer, cl_uint, cl_uint, cl_ulong, cl::Buffer>;
using DevelopCodesKernel = cl::KernelFunctor<cl::Buffer, cl::Buffer, cl::Buffer, cl_uint, cl_uint, cl_ulong,
                                             cl::Buffer, cl::Buffer, cl_uint, cl::Buffer>;

template <typename Real>
std::vector<Real> converted(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

// light = sum · 2^exponent / white (the last for linear codes only), as two factors that are finite.
template <typename Real>
std::vector<LightScale<Real>> light_scales(const RenderPlan& plan) {
  const double code_light = plan.capture.transfer.is_linear() ? 1.0 / plan.capture.white_code : 1.0;
  std::vector<LightScale<Real>> scales;
  for (const PlannedFunction& function : plan.functions) {
    const int half = function.summary.exponent / 2;
    scales.push_back({static_cast<Real>(std::scalbn(code_light, half)),
                      static_cast<Real>(std::scalbn(1.0, function.summary.exponent - half))});
    if (!std::isfinite(scales.back().first) || !std::isfinite(scales.back().second)) {
      throw UsageError(
          format("M{} has gains beyond 2^{}, more than single precision holds; use --precision "
                 "double",
                 function.tag, function.summary.exponent));
    }
  }
  return scales;
}

// Whether fma() is the device's own. Devices that would emulate it do not report it, and a CPU's emulation
// is 20 times slower than rounding twice.
bool has_fma(const cl::Device& device, bool single) {
  const cl_device_fp_config config =
      single ? device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() : device.getInfo<CL_DEVICE_DOUBLE_FP_CONFIG>();
  return (config & CL_FP_FMA) != 0;
}

// Buffers made in a scope no longer count when it ends.
class HeldBytes {
 public:
  explicit HeldBytes(std::uint64_t& held) : held_(held), before_(held) {}
  ~HeldBytes() { held_ = before_; }
  HeldBytes(const HeldBytes&) = delete;
  HeldBytes& operator=(const HeldBytes&) = delete;

 private:
  std::uint64_t& held_;
  std::uint64_t before_;
};

}  // namespace

class OpenClRenderer::Implementation {
 public:
  explicit Implementation(const OpenClOptions& options)
      : options_(options),
        device_(pick_device(options)),
        info_(describe_device(device_)),
        shape_(work_shape(options, info_)) {
    if (options.precision == Precision::double_ && !info_.has_double) {
      throw DeviceError(format("{} has no double precision; use --precision single", info_.name));
    }
    context_ = cl::Context(device_);
    queue_ = cl::CommandQueue(context_, device_, CL_QUEUE_PROFILING_ENABLE);
    programs_ = std::make_unique<ProgramStore>(context_, device_, options.cache_folder, [this](auto&) {
      if (announced_ || !options_.announce) return;
      announced_ = true;
      options_.announce(format("building kernels for {}; they are kept for the next time", info_.name));
    });
  }

  [[nodiscard]] const std::string& name() const { return info_.name; }
  [[nodiscard]] std::string precision() const { return to_text(options_.precision); }
  [[nodiscard]] const RenderStatistics& statistics() const { return statistics_; }
  [[nodiscard]] std::string report() const {
    const double megabytes = static_cast<double>(statistics_.payload_bytes) * 1e-6;
    return format(
        "{} precision; {} blocks of {:.1f} MB made ready in {:.1f} ms, read by the kernel in {:.1f} ms "
        "({:.1f} GB/s); codes or light in {:.1f} ms; at most {:.1f} MB on the device",
        to_text(options_.precision), statistics_.blocks, megabytes, statistics_.read_ms,
        statistics_.expose_ms, statistics_.expose_ms > 0 ? megabytes / statistics_.expose_ms : 0.0,
        statistics_.develop_ms, static_cast<double>(statistics_.device_bytes) * 1e-6);
  }

  void prepare(const RenderPlan& plan, const OutputFormat& output) {
    try {
      if (!plan.blocks.empty()) expose_program(plan, light_source_for(plan));
      develop_program(plan, output);
    } catch (const cl::Error& error) {
      throw DeviceError(describe(error, format("{} failed", info_.name)));
    }
  }

  Picture render(const RenderPlan& plan, CaptureSource& source, const OutputFormat& output) {
    try {
      return options_.precision == Precision::single_ ? render_as<float>(plan, source, output)
                                                      : render_as<double>(plan, source, output);
    } catch (const cl::Error& error) {
      throw DeviceError(describe(error, format("{} failed", info_.name)));
    }
  }

 private:
  static cl::Device pick_device(const OpenClOptions& options) {
    const std::vector<cl::Device> devices = all_devices();
    if (options.device >= devices.size()) {
      throw DeviceError(format("there is no OpenCL device {}", options.device));
    }
    return devices[options.device];
  }

  template <typename Real>
  Picture render_as(const RenderPlan& plan, CaptureSource& source, const OutputFormat& output) {
    statistics_ = {};
    held_bytes_ = 0;
    pending_bytes_ = 0;  // a render that failed may have left some
    const FunctionMap map = map_functions(plan);
    const cl::Buffer function_of_lane = upload(map.of_lane);
    const cl::Buffer sums = expose<Real>(plan, source, map, function_of_lane);
    Picture picture = develop<Real>(plan, output, sums, function_of_lane);
    programs_->save_new_binaries();
    return picture;
  }

  // A read-only buffer with these values. Never of no bytes: OpenCL has no such thing.
  template <typename T>
  cl::Buffer upload(const std::vector<T>& values) {
    const std::uint64_t bytes = std::max<std::uint64_t>(values.size() * sizeof(T), sizeof(T));
    cl::Buffer buffer = allocate(bytes, CL_MEM_READ_ONLY);
    if (!values.empty()) {
      queue_.enqueueWriteBuffer(buffer, CL_TRUE, 0, values.size() * sizeof(T), values.data());
    }
    return buffer;
  }

  cl::Buffer allocate(std::uint64_t bytes, cl_mem_flags flags) {
    if (bytes > info_.largest_allocation_bytes) {
      throw DeviceError(
          format("{} allocates at most {} MB at a time and {} MB are needed; use a device "
                 "with more memory, or --renderer reference",
                 info_.name, info_.largest_allocation_bytes >> 20, bytes >> 20));
    }
    count_device_bytes(bytes);
    return {context_, flags, bytes};
  }

  void count_device_bytes(std::uint64_t bytes) {
    held_bytes_ += bytes;
    statistics_.device_bytes = std::max(statistics_.device_bytes, held_bytes_);
  }

  [[nodiscard]] std::string common_options(const RenderPlan& plan) const {
    const bool single = options_.precision == Precision::single_;
    return format("-cl-std=CL1.2 -DNUTIK_PRECISION={} -DNUTIK_HAS_FMA={} -DNUTIK_CHANNELS={}",
                  single ? "NUTIK_SINGLE" : "NUTIK_DOUBLE", has_fma(device_, single) ? 1 : 0,
                  plan.capture.shape.channels);
  }

  [[nodiscard]] LightSource light_source_for(const RenderPlan& plan) const {
    const bool permutes = shape_.lanes == kLightPieces && info_.native_float_lanes >= kLightPieces;
    return light_source(plan.capture, options_.precision, permutes);
  }

  cl::Program expose_program(const RenderPlan& plan, const LightSource& light) {
    return programs_->get(
        "expose", kExposeSource,
        format("{} -DNUTIK_CODE_BYTES={} -DNUTIK_LIGHT={} -DNUTIK_ITEM_PIXELS={} -DNUTIK_ITEM_TILES={} "
               "-DNUTIK_LANES={}",
               common_options(plan), plan.capture.code_bytes, light.kind, shape_.item_pixels,
               shape_.item_tiles, shape_.lanes));
  }

  cl::Program develop_program(const RenderPlan& plan, const OutputFormat& output) {
    const std::size_t raster_bytes = holds_codes(output.type) ? value_bytes(output.type) : 1;
    return programs_->get("develop", kDevelopSource,
                          format("{} -DNUTIK_CODE_BYTES=1 -DNUTIK_ITEM_PIXELS={} -DNUTIK_ITEM_TILES={} "
                                 "-DNUTIK_LANES={} -DNUTIK_RASTER_BYTES={}",
                                 common_options(plan), shape_.item_pixels, shape_.item_tiles,
                                 std::min(shape_.lanes, kTileSide), raster_bytes));
  }

  [[nodiscard]] cl::EnqueueArgs items(std::uint64_t count) {
    const std::uint64_t group = shape_.group_items;
    return {queue_, cl::NDRange((count + group - 1) / group * group), cl::NDRange(group)};
  }

  static double milliseconds(const cl::Event& event) {
    return static_cast<double>(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                               event.getProfilingInfo<CL_PROFILING_COMMAND_START>()) *
           1e-6;
  }

  // Σ_k v_k w_k of every pixel, tile-major.
  template <typename Real>
  cl::Buffer expose(const RenderPlan& plan, CaptureSource& source, const FunctionMap& map,
                    const cl::Buffer& function_of_lane) {
    const TileGrid grid(plan.capture.shape);
    const std::uint64_t sum_bytes =
        grid.tile_count() * plan.capture.shape.channels * kTilePixels * sizeof(Real);
    cl::Buffer sums = allocate(sum_bytes, CL_MEM_READ_WRITE);
    if (plan.blocks.empty()) {
      queue_.enqueueFillBuffer(sums, Real{0}, 0, sum_bytes);
      return sums;
    }
    const HeldBytes scope(held_bytes_);  // of what is not the picture
    const LightSource light = light_source_for(plan);
    ExposeKernel kernel(expose_program(plan, light), "expose");

    const cl::Buffer weights = upload(converted<Real>(plan.weights));
    const cl::Buffer boundaries = upload(converted<Real>(plan.boundaries));
    const cl::Buffer spans = upload(plan.spans);
    const cl::Buffer function_of_tile = upload(map.of_tile);
    const cl::Buffer transfer = upload(converted<Real>(light.values));

    bool first = true;
    for (std::size_t b = 0; b < plan.blocks.size();) {
      const HeldBytes chunk_scope(held_bytes_);
      const auto start = std::chrono::steady_clock::now();
      const Chunk chunk = next_chunk(plan, source, b);
      statistics_.read_ms +=
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
      const cl::Buffer entries = upload(chunk.entries);
      const cl::Event event = kernel(items(shape_.items(grid.tile_count())), chunk.payload, entries,
                                     static_cast<cl_uint>(chunk.entries.size()), spans, weights, boundaries,
                                     static_cast<cl_uint>(plan.function_count()), function_of_tile,
                                     function_of_lane, transfer, sums, grid.tile_count(), first ? 1u : 0u);
      event.wait();
      statistics_.expose_ms += milliseconds(event);
      statistics_.blocks += chunk.entries.size();
      ++statistics_.launches;
      first = false;
      b += chunk.entries.size();
    }
    return sums;
  }

  // Consecutive planned blocks that one launch reads.
  struct Chunk {
    cl::Buffer payload;
    std::uint64_t bytes = 0;
    std::vector<BlockEntry> entries;
  };

  [[nodiscard]] std::uint64_t chunk_limit() const {
    const std::uint64_t wanted = options_.chunk_bytes != 0 ? options_.chunk_bytes : kDefaultChunkBytes;
    return std::min(wanted, info_.largest_allocation_bytes);
  }

  Chunk next_chunk(const RenderPlan& plan, CaptureSource& source, std::size_t first) {
    Chunk chunk;
    const std::span<const std::byte> region = source.region();
    const bool in_place = !region.empty() && info_.shares_host_memory;
    std::uint64_t begin = 0;  // of the chunk, within the region
    for (std::size_t b = first; b < plan.blocks.size(); ++b) {
      const PlannedBlock& planned = plan.blocks[b];
      const std::uint64_t payload_bytes =
          pending_bytes_ != 0 ? pending_bytes_ : source.prepare(planned.block);
      pending_bytes_ = 0;
      std::uint64_t offset = chunk.bytes;
      if (in_place) {
        const std::uint64_t in_region = source.region_offset(planned.block);
        if (b == first) begin = in_region / kPageBytes * kPageBytes;
        offset = in_region - begin;
      }
      const std::uint64_t end = align_up(offset + payload_bytes, kBlockAlignment);
      if (b > first && end > chunk_limit()) {
        pending_bytes_ = payload_bytes;
        break;
      }
      if (end > info_.largest_allocation_bytes) {
        throw DeviceError(
            format("a block of {} samples takes {} MB and {} allocates at most {} MB at a "
                   "time; encode with fewer samples a block (--block-samples)",
                   planned.extent.sample_count, end >> 20, info_.name, info_.largest_allocation_bytes >> 20));
      }
      if (!in_place) {
        // Address space for a whole chunk at once, for growing would lose what was read into it.
        if (b == first) chunk_memory_.reserve(std::max(end, chunk_limit()));
        source.read(planned.block, {chunk_memory_.data() + offset, payload_bytes});
      }
      chunk.entries.push_back({offset, planned.table_row, b, planned.extent.sample_count, 0});
      chunk.bytes = end;
      statistics_.payload_bytes += payload_bytes;
    }
    count_device_bytes(chunk.bytes);
    if (info_.shares_host_memory) {
      auto* host = in_place ? const_cast<std::byte*>(region.data()) + begin : chunk_memory_.data();
      const std::uint64_t bytes = in_place ? std::min(chunk.bytes, region.size() - begin) : chunk.bytes;
      chunk.payload = cl::Buffer(context_, CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR, bytes, host);
    } else {
      chunk.payload = cl::Buffer(context_, CL_MEM_READ_ONLY, chunk.bytes);
      queue_.enqueueWriteBuffer(chunk.payload, CL_TRUE, 0, chunk.bytes, chunk_memory_.data());
    }
    return chunk;
  }

  template <typename Real>
  Picture develop(const RenderPlan& plan, const OutputFormat& output, const cl::Buffer& sums,
                  const cl::Buffer& function_of_lane) {
    const Shape& shape = plan.capture.shape;
    const bool codes = holds_codes(output.type);
    const cl::Program program = develop_program(plan, output);
    const cl::Buffer scales = upload(light_scales<Real>(plan));
    const std::uint64_t tile_count = TileGrid(shape).tile_count();
    const std::uint64_t item_count = shape_.items(tile_count);
    Picture picture(shape, output.type, output.white_code);
    if (!codes) {
      const cl::Buffer raster = allocate(shape.value_count() * sizeof(Real), CL_MEM_WRITE_ONLY);
      DevelopLightKernel kernel(program, "develop_light");
      const cl::Event event = kernel(items(item_count), sums, scales, function_of_lane, shape.width,
                                     shape.height, tile_count, raster);
      std::vector<Real> light(shape.value_count());
      queue_.enqueueReadBuffer(raster, CL_TRUE, 0, light.size() * sizeof(Real), light.data());
      statistics_.develop_ms = milliseconds(event);
      if (output.type == ValueType::light32) {
        std::transform(light.begin(), light.end(), picture.values<float>().begin(),
                       [](Real value) { return static_cast<float>(value); });
      } else {
        std::copy(light.begin(), light.end(), picture.values<double>().begin());
      }
      return picture;
    }
    const CodeSearch<Real> search = code_search<Real>(plan.capture.transfer, output.white_code);
    const cl::Buffer raster = allocate(picture.bytes.size(), CL_MEM_WRITE_ONLY);
    DevelopCodesKernel kernel(program, "develop_codes");
    const cl::Event event =
        kernel(items(item_count), sums, scales, function_of_lane, shape.width, shape.height, tile_count,
               upload(search.thresholds), upload(search.guesses), static_cast<cl_uint>(search.guesses.size()),
               raster);
    queue_.enqueueReadBuffer(raster, CL_TRUE, 0, picture.bytes.size(), picture.bytes.data());
    statistics_.develop_ms = milliseconds(event);
    return picture;
  }

  OpenClOptions options_;
  cl::Device device_;
  DeviceInfo info_;
  WorkShape shape_;
  cl::Context context_;
  cl::CommandQueue queue_;
  std::unique_ptr<ProgramStore> programs_;
  bool announced_ = false;
  PageBuffer chunk_memory_;
  std::uint64_t pending_bytes_ = 0;  // of a block that was prepared and did not fit the chunk before
  std::uint64_t held_bytes_ = 0;
  RenderStatistics statistics_;
};

OpenClRenderer::OpenClRenderer(const OpenClOptions& options) {
  try {
    implementation_ = std::make_unique<Implementation>(options);
  } catch (const cl::Error& error) {
    throw DeviceError(describe(error, "the OpenCL device cannot be started"));
  }
}

OpenClRenderer::~OpenClRenderer() = default;

void OpenClRenderer::prepare(const RenderPlan& plan, const OutputFormat& output) {
  implementation_->prepare(plan, output);
}

Picture OpenClRenderer::render(const RenderPlan& plan, CaptureSource& source, const OutputFormat& output) {
  return implementation_->render(plan, source, output);
}

std::string OpenClRenderer::name() const { return implementation_->name(); }

std::string OpenClRenderer::precision() const { return implementation_->precision(); }

std::string OpenClRenderer::report() const { return implementation_->report(); }

const RenderStatistics& OpenClRenderer::statistics() const { return implementation_->statistics(); }

}  // namespace nutik
