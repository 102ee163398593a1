#include "opencl/opencl_renderer.hpp"

#include <algorithm>
#include <array>
#include <chrono>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "opencl/block_feed.hpp"
#include "opencl/build_options.hpp"
#include "opencl/function_map.hpp"
#include "opencl/kernel_layout.hpp"
#include "opencl/kernel_sources.hpp"
#include "opencl/kernel_tables.hpp"
#include "opencl/light_pieces.hpp"
#include "opencl/light_source.hpp"
#include "opencl/opencl_api.hpp"
#include "opencl/program_store.hpp"
#include "render/code_scale.hpp"

namespace nutik {
namespace {

// Large enough that launching costs nothing, small enough that reading the next one hides behind it.
constexpr std::uint64_t kChunkBytes = 64ull << 20;
constexpr std::uint64_t kDefaultMemoryBytes = 4ull << 30;

using ExposeKernel =
    cl::KernelFunctor<cl::Buffer, cl::Buffer, cl_uint, cl::Buffer, cl::Buffer, cl::Buffer, cl_uint,
                      cl::Buffer, cl::Buffer, cl::Buffer, cl::Buffer, cl_ulong, cl_uint>;
using DevelopSumsKernel = cl::KernelFunctor<cl::Buffer, cl_uint, cl_uint, cl_ulong, cl::Buffer>;
using DevelopCodesKernel = cl::KernelFunctor<cl::Buffer, cl::Buffer, cl::Buffer, cl_uint, cl_uint, cl_ulong,
                                             cl::Buffer, cl::Buffer, cl_uint, cl::Buffer>;

// Whether fma() is the device's own. Devices that would emulate it do not report it, and a CPU's emulation
// is 20 times slower than rounding twice.
bool has_fma(const cl::Device& device, Precision precision) {
  switch (precision) {
    case Precision::single_:
    case Precision::compensated: return (device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_FMA) != 0;
    case Precision::double_: return (device.getInfo<CL_DEVICE_DOUBLE_FP_CONFIG>() & CL_FP_FMA) != 0;
    case Precision::fixed: break;
  }
  return false;
}

// Whether a value has the first code or the last.
bool has_end_code(const Picture& codes) {
  const auto is_end = [&](std::uint32_t code) { return code == 0 || code == codes.white_code; };
  return codes.type == ValueType::code8 ? std::ranges::any_of(codes.values<std::uint8_t>(), is_end)
                                        : std::ranges::any_of(codes.values<std::uint16_t>(), is_end);
}

// Nothing is read from a capture any more when its exposure ends, however it does.
class StoppedAtEnd {
 public:
  explicit StoppedAtEnd(BlockFeed& feed) : feed_(feed) {}
  ~StoppedAtEnd() { feed_.stop(); }
  StoppedAtEnd(const StoppedAtEnd&) = delete;
  StoppedAtEnd& operator=(const StoppedAtEnd&) = delete;

 private:
  BlockFeed& feed_;
};

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

std::span<const Precision> precisions_of(const DeviceInfo& device) {
  static constexpr std::array kWithDouble{Precision::single_, Precision::double_, Precision::fixed,
                                          Precision::compensated};
  static constexpr std::array kWithoutDouble{Precision::single_, Precision::fixed, Precision::compensated};
  if (device.has_double) return kWithDouble;
  return kWithoutDouble;
}

class OpenClRenderer::Implementation {
 public:
  explicit Implementation(const OpenClOptions& options)
      : options_(options), device_(pick_device(options)), info_(describe_device(device_)) {
    set_precision(options.precision);
    context_ = cl::Context(device_);
    queue_ = cl::CommandQueue(context_, device_, CL_QUEUE_PROFILING_ENABLE);
    feed_ = std::make_unique<BlockFeed>(context_, device_, info_, feed_limits());
    programs_ = std::make_unique<ProgramStore>(context_, device_, options.cache_folder, [this](auto&) {
      if (announced_ || !options_.announce) return;
      announced_ = true;
      options_.announce(format("building kernels for {}; they are kept for the next time", info_.name));
    });
  }

  void set_precision(std::optional<Precision> precision) {
    if (precision == Precision::double_ && !info_.has_double) {
      throw DeviceError(
          format("{} has no double precision; use --precision auto, compensated or fixed", info_.name));
    }
    options_.precision = precision;
  }
  [[nodiscard]] std::span<const Precision> precisions() const { return precisions_of(info_); }

  [[nodiscard]] const std::string& name() const { return info_.name; }
  [[nodiscard]] std::string precision() const { return to_text(choice_.precision()); }
  [[nodiscard]] const RenderStatistics& statistics() const { return statistics_; }
  [[nodiscard]] Saturation saturation() const { return saturation_; }
  [[nodiscard]] const PrecisionChoice& choice() const { return choice_; }

  // Said only of what the program chose: a person who asks for an arithmetic gets it.
  [[nodiscard]] std::string warning() const {
    if (options_.precision || choice_.is_right_enough()) return {};
    return format("no arithmetic of {} is sure to be right to {} of a code here; {} is the closest: {}",
                  info_.name, kMostSteps, to_text(choice_.precision()),
                  error_text(choice_.bound.worst, output_));
  }

  [[nodiscard]] std::string report() const {
    const double megabytes = static_cast<double>(statistics_.payload_bytes) * 1e-6;
    return format(
               "{} precision; {} block{} of {:.1f} MB made ready in {:.1f} ms, read by the kernel in {:.1f} "
               "ms "
               "({:.1f} GB/s); codes or light in {:.1f} ms; at most {:.1f} MB on the device",
               to_text(choice_.precision()), statistics_.blocks, statistics_.blocks == 1 ? "" : "s",
               megabytes, statistics_.read_ms, statistics_.expose_ms,
               statistics_.expose_ms > 0 ? megabytes / statistics_.expose_ms : 0.0, statistics_.develop_ms,
               static_cast<double>(statistics_.device_bytes) * 1e-6) +
           choice_text();
  }

  void hold(const CaptureSource* source) { feed_->hold(source); }

  void prepare(const RenderPlan& plan, const OutputFormat& output) {
    try {
      const Work work = work_for(choose(plan, output).precision());
      if (!plan.blocks.empty()) expose_program(work, plan, light_source_for(work, plan));
      develop_program(work, plan, output);
    } catch (const cl::Error& error) {
      throw DeviceError(describe(error, format("{} failed", info_.name)));
    }
  }

  Picture render(const RenderPlan& plan, CaptureSource& source, const OutputFormat& output) {
    try {
      statistics_ = {};
      saturation_ = {};
      held_bytes_ = 0;
      output_ = output;
      choice_ = choose(plan, output);
      const Work work = work_for(choice_.precision());
      const FunctionMap map = map_functions(plan);
      const cl::Buffer function_of_lane = upload(map.of_lane);
      const cl::Buffer sums = expose(work, plan, source, map, function_of_lane);
      Picture picture = holds_codes(output.type) ? develop_counted(work, plan, output, sums, function_of_lane)
                                                 : develop_light(work, plan, output, output.type, sums);
      programs_->save_new_binaries();
      return picture;
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

  [[nodiscard]] FeedLimits feed_limits() const {
    const std::uint64_t memory = std::min(
        options_.memory_bytes != 0 ? options_.memory_bytes : kDefaultMemoryBytes, info_.memory_bytes / 2);
    FeedLimits limits{std::min(kChunkBytes, memory / 4), memory / 2};
    if (options_.chunk_bytes != 0) limits.chunk_bytes = options_.chunk_bytes;
    return limits;
  }

  [[nodiscard]] PrecisionChoice choose(const RenderPlan& plan, const OutputFormat& output) const {
    if (options_.precision) return choose_precision(plan, output, std::array{*options_.precision});
    return choose_precision(plan, output, precisions_of(info_));
  }

  [[nodiscard]] Work work_for(Precision precision) const {
    return {precision, work_shape(options_, precision, info_),
            options_.use_fma && has_fma(device_, precision)};
  }

  // A line of its own: what the arithmetic may err by, and what faster ones would have.
  [[nodiscard]] std::string choice_text() const {
    std::string text =
        format("\n{}: {}", to_text(choice_.precision()), error_text(choice_.bound.worst, output_));
    for (const ErrorBound& bound : choice_.rejected) {
      text += format("; not {}: only {}", to_text(bound.precision), error_text(bound.worst, output_));
    }
    return text;
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

  [[nodiscard]] LightSource light_source_for(const Work& work, const RenderPlan& plan) const {
    const bool permutes = work.shape.lanes == kLightPieces && info_.native_float_lanes >= kLightPieces;
    return light_source(plan.capture, work.precision, permutes);
  }

  cl::Program expose_program(const Work& work, const RenderPlan& plan, const LightSource& light) {
    return programs_->get("expose", kExposeSource, expose_options(work, plan.capture, light));
  }

  cl::Program develop_program(const Work& work, const RenderPlan& plan, const OutputFormat& output) {
    return programs_->get("develop", kDevelopSource, develop_options(work, plan.capture, output));
  }

  [[nodiscard]] cl::EnqueueArgs items(const WorkShape& shape, std::uint64_t tile_count) {
    const std::uint64_t group = shape.group_items;
    const std::uint64_t count = shape.items(tile_count);
    return {queue_, cl::NDRange((count + group - 1) / group * group), cl::NDRange(group)};
  }

  static double milliseconds(const cl::Event& event) {
    return static_cast<double>(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                               event.getProfilingInfo<CL_PROFILING_COMMAND_START>()) *
           1e-6;
  }

  // Σ_k v_k w_k of every pixel, tile-major.
  cl::Buffer expose(const Work& work, const RenderPlan& plan, CaptureSource& source, const FunctionMap& map,
                    const cl::Buffer& function_of_lane) {
    const TileGrid grid(plan.capture.shape);
    const std::uint64_t bytes =
        grid.tile_count() * plan.capture.shape.channels * kTilePixels * sum_bytes(work.precision);
    cl::Buffer sums = allocate(bytes, CL_MEM_READ_WRITE);
    if (plan.blocks.empty()) {
      queue_.enqueueFillBuffer(sums, std::uint8_t{0}, 0, bytes);  // 0 in every arithmetic
      return sums;
    }
    const HeldBytes scope(held_bytes_);  // of what is not the picture
    const LightSource light = light_source_for(work, plan);
    ExposeKernel kernel(expose_program(work, plan, light), "expose");

    const ExposureTables tables = exposure_tables(plan, work.precision, light);
    const cl::Buffer weights = upload(tables.weights);
    const cl::Buffer boundaries = upload(tables.boundaries);
    const cl::Buffer spans = upload(plan.spans);
    const cl::Buffer function_of_tile = upload(map.of_tile);
    const cl::Buffer transfer = upload(tables.light);

    feed_->start(plan, source);
    const StoppedAtEnd stopped(*feed_);
    bool first = true;
    while (std::optional<BlockFeed::Chunk> chunk = next_chunk()) {
      if (options_.last_block_first) std::reverse(chunk->entries.begin(), chunk->entries.end());
      const HeldBytes chunk_scope(held_bytes_);
      count_device_bytes(feed_->bytes());
      const cl::Buffer entries = upload(chunk->entries);
      const cl::Event event = kernel(items(work.shape, grid.tile_count()), chunk->payload, entries,
                                     static_cast<cl_uint>(chunk->entries.size()), spans, weights, boundaries,
                                     static_cast<cl_uint>(plan.function_count()), function_of_tile,
                                     function_of_lane, transfer, sums, grid.tile_count(), first ? 1u : 0u);
      event.wait();
      statistics_.expose_ms += milliseconds(event);
      statistics_.blocks += chunk->entries.size();
      statistics_.payload_bytes += chunk->payload_bytes;
      ++statistics_.launches;
      first = false;
    }
    return sums;
  }

  std::optional<BlockFeed::Chunk> next_chunk() {
    const auto start = std::chrono::steady_clock::now();
    auto chunk = feed_->next();
    statistics_.read_ms +=
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return chunk;
  }

  // As light of this type, for a picture that will be stored as `output`.
  Picture develop_light(const Work& work, const RenderPlan& plan, const OutputFormat& output, ValueType type,
                        const cl::Buffer& sums) {
    const Shape& shape = plan.capture.shape;
    const std::uint64_t tile_count = TileGrid(shape).tile_count();
    Bytes of_sums(shape.value_count() * sum_bytes(work.precision));
    const cl::Buffer raster = allocate(of_sums.size(), CL_MEM_WRITE_ONLY);
    DevelopSumsKernel kernel(develop_program(work, plan, output), "develop_sums");
    const cl::Event event =
        kernel(items(work.shape, tile_count), sums, shape.width, shape.height, tile_count, raster);
    queue_.enqueueReadBuffer(raster, CL_TRUE, 0, of_sums.size(), of_sums.data());
    statistics_.develop_ms = milliseconds(event);
    Picture picture(shape, type, output.white_code);
    store_light(plan, work.precision, of_sums, picture);
    return picture;
  }

  // Codes, and how many pixels saturate. The kernel knows no negative codes and counts nothing: where a plan's
  // functions can saturate, or negative light is to be seen, the sums are read and turned into light here.
  Picture develop_counted(const Work& work, const RenderPlan& plan, const OutputFormat& output,
                          const cl::Buffer& sums, const cl::Buffer& function_of_lane) {
    const CodeScale scale(plan.capture.transfer, output);
    if (output.negative != NegativeLight::saturate) {
      const Picture light = develop_light(work, plan, output, ValueType::light64, sums);
      saturation_ = count_saturated(light, scale);
      return encoded(light, scale, output);
    }
    Picture codes = develop_codes(work, plan, output, sums, function_of_lane);
    if (can_saturate(plan, scale) && has_end_code(codes)) {
      const double develop_ms = statistics_.develop_ms;
      saturation_ = count_saturated(develop_light(work, plan, output, ValueType::light64, sums), scale);
      statistics_.develop_ms += develop_ms;
    }
    return codes;
  }

  Picture develop_codes(const Work& work, const RenderPlan& plan, const OutputFormat& output,
                        const cl::Buffer& sums, const cl::Buffer& function_of_lane) {
    const Shape& shape = plan.capture.shape;
    const std::uint64_t tile_count = TileGrid(shape).tile_count();
    const CodeTables tables = code_tables(plan, work.precision, output.white_code);
    Picture picture(shape, output.type, output.white_code);
    const cl::Buffer raster = allocate(picture.bytes.size(), CL_MEM_WRITE_ONLY);
    DevelopCodesKernel kernel(develop_program(work, plan, output), "develop_codes");
    const cl::Event event =
        kernel(items(work.shape, tile_count), sums, upload(tables.scales), function_of_lane, shape.width,
               shape.height, tile_count, upload(tables.thresholds), upload(tables.guesses),
               static_cast<cl_uint>(tables.guesses.size()), raster);
    queue_.enqueueReadBuffer(raster, CL_TRUE, 0, picture.bytes.size(), picture.bytes.data());
    statistics_.develop_ms = milliseconds(event);
    return picture;
  }

  OpenClOptions options_;
  cl::Device device_;
  DeviceInfo info_;
  cl::Context context_;
  cl::CommandQueue queue_;
  std::unique_ptr<ProgramStore> programs_;
  bool announced_ = false;
  std::unique_ptr<BlockFeed> feed_;
  std::uint64_t held_bytes_ = 0;
  RenderStatistics statistics_;
  Saturation saturation_;
  OutputFormat output_;     // of the last picture
  PrecisionChoice choice_;  // likewise
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

void OpenClRenderer::set_precision(std::optional<Precision> precision) {
  implementation_->set_precision(precision);
}

std::span<const Precision> OpenClRenderer::precisions() const { return implementation_->precisions(); }

void OpenClRenderer::hold(const CaptureSource* source) { implementation_->hold(source); }

Saturation OpenClRenderer::saturation() const { return implementation_->saturation(); }

std::string OpenClRenderer::name() const { return implementation_->name(); }

std::string OpenClRenderer::precision() const { return implementation_->precision(); }

std::string OpenClRenderer::report() const { return implementation_->report(); }

std::string OpenClRenderer::warning() const { return implementation_->warning(); }

const PrecisionChoice& OpenClRenderer::choice() const { return implementation_->choice(); }

const RenderStatistics& OpenClRenderer::statistics() const { return implementation_->statistics(); }

}  // namespace nutik
