#include "opencl/opencl_renderer.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <type_traits>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "opencl/allocation_cuts.hpp"
#include "opencl/arithmetic_choice.hpp"
#include "opencl/block_feed.hpp"
#include "opencl/cache_folder.hpp"
#include "opencl/developer.hpp"
#include "opencl/device_lookups.hpp"
#include "opencl/device_memory.hpp"
#include "opencl/exposer.hpp"
#include "opencl/gain_columns.hpp"
#include "opencl/kernel_sources.hpp"
#include "opencl/light_source.hpp"
#include "opencl/opencl_api.hpp"
#include "opencl/program_store.hpp"
#include "opencl/render_memory.hpp"
#include "opencl/sample_combiner.hpp"
#include "opencl/self_test.hpp"
#include "render/combining_renderer.hpp"

namespace nutik {
namespace {

constexpr std::uint64_t kDefaultMemoryBytes = 4ull << 30;

// A band's sums: large enough that launches cost nothing and a device is busy.
constexpr std::uint64_t kBandBytes = 64ull << 20;

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

// What one render is made of.
struct Request {
  const RenderPlan& plan;
  CaptureSource& source;
  const OutputFormat& output;
  const Rectangle& rectangle;
  const RenderControl& control;
};

}  // namespace

std::span<const Precision> precisions_of(const DeviceInfo& device) {
  static constexpr std::array kWithDouble{Precision::single_, Precision::double_, Precision::fixed,
                                          Precision::compensated};
  static constexpr std::array kWithoutDouble{Precision::single_, Precision::fixed, Precision::compensated};
  if (device.has_double) return kWithDouble;
  return kWithoutDouble;
}

std::map<Precision, Verdict> kept_verdicts(std::size_t device, const std::filesystem::path& cache_folder) {
  return VerdictStore(all_devices().at(device), cache_folder).all();
}

class OpenClRenderer::Implementation {
 public:
  explicit Implementation(const OpenClOptions& options)
      : options_(options),
        device_(pick_device(options)),
        info_(info_of(device_, options)),
        verdicts_(device_, options.cache_folder) {
    if (options.precision) check_precision(*options.precision);
    context_ = cl::Context(device_);
    queue_ = cl::CommandQueue(context_, device_, CL_QUEUE_PROFILING_ENABLE);
    feed_ = std::make_unique<BlockFeed>(context_, device_, info_);
    columns_ = std::make_unique<GainColumns>(queue_, table_bytes());
    lookups_ = std::make_unique<DeviceLookups>(table_bytes());
    programs_ = std::make_unique<ProgramStore>(context_, device_, options.cache_folder, [this](auto&) {
      if (announced_ || !options_.announce) return;
      announced_ = true;
      options_.announce(format("building and testing kernels for {}{}", info_.name,
                               can_be_kept_in(options_.cache_folder) ? "; they are kept for the next time" : ""));
    });
  }

  [[nodiscard]] const DeviceInfo& info() const { return info_; }

  void keep_resident(const CaptureSource* source) {
    const std::scoped_lock turn(turn_);
    feed_->keep_resident(source);
    resident_ = source;
    incremental_.clear();
  }

  void prepare(const RenderPlan& plan, const OutputFormat& output) {
    in_turn([&] {
      Rendered ignored;
      choose(plan, output, options_.precision, {}, ignored);
    });
  }

  std::string fault_in(Precision precision, const RenderPlan& plan, const OutputFormat& output) {
    check_precision(precision);
    return in_turn([&] { return fault_text_of(precision, plan, output); });
  }

  Rendered render(const Request& request) {
    if (request.plan.combine != Combine::integral) return combine(request);
    const std::optional<Precision> asked = request.control.precision ? request.control.precision : options_.precision;
    if (asked) check_precision(*asked);
    return in_turn([&] {
      Rendered rendered;
      choose(request.plan, request.output, asked, request.control, rendered);
      const Work work = work_for(rendered.precision);
      expose_and_develop(work, request, develop_program(work, request.plan, request.output), rendered);
      programs_->save_new_binaries();
      return rendered;
    });
  }

 private:
  template <typename Use>
  std::invoke_result_t<Use> in_turn(Use use) {
    const std::scoped_lock turn(turn_);
    try {
      return use();
    } catch (const cl::Error& error) {
      throw device_failed(error, format("{} failed", info_.name));
    }
  }

  static cl::Device pick_device(const OpenClOptions& options) {
    const std::vector<cl::Device> devices = all_devices();
    if (options.device >= devices.size()) {
      throw DeviceError(format("there is no OpenCL device {}", options.device));
    }
    return devices[options.device];
  }

  static DeviceInfo info_of(const cl::Device& device, const OpenClOptions& options) {
    DeviceInfo info = describe_device(device);
    if (options.allocation_bytes != 0) {
      info.largest_allocation_bytes = std::min(info.largest_allocation_bytes, options.allocation_bytes);
    }
    if (!options.heeds_loop_limit) info.loop_limit = 0;
    return info;
  }

  [[nodiscard]] std::uint64_t memory_bytes() const {
    return std::min(options_.memory_bytes != 0 ? options_.memory_bytes : kDefaultMemoryBytes, info_.memory_bytes / 2);
  }
  // What tables may take on the device between renders, and maps as much.
  [[nodiscard]] std::uint64_t table_bytes() const { return memory_bytes() / 16; }

  [[nodiscard]] RenderMemory memory_for(const Request& request, Precision precision) const {
    const Shape shape{request.rectangle.width, request.rectangle.height, request.plan.capture.shape.channels};
    const std::uint64_t allowed = request.control.memory_bytes;
    RenderMemory memory = allowed == 0
                              ? memory_for_blocks(memory_bytes())
                              : memory_for_render(std::min(allowed, std::max(memory_bytes(), info_.memory_bytes / 2)),
                                                  request.plan, request.source, shape, request.output.type, precision);
    if (options_.chunk_bytes != 0) memory.feed.chunk_bytes = options_.chunk_bytes;
    return memory;
  }

  void check_precision(Precision precision) const {
    if (precision != Precision::double_ || info_.has_double) return;
    throw DeviceError(format("{} has no double precision; use auto, compensated or fixed", info_.name),
                      {Setting::precision});
  }

  // Kernels of the arithmetic that is chosen are built and tested.
  void choose(const RenderPlan& plan, const OutputFormat& output, std::optional<Precision> asked,
              const RenderControl& control, Rendered& rendered) {
    choose_arithmetic(
        plan, output, precisions_of(info_), asked, info_.name, control,
        [&](Precision precision) { return fault_text_of(precision, plan, output); }, rendered);
  }

  std::string fault_text_of(Precision precision, const RenderPlan& plan, const OutputFormat& output) {
    const Verdict verdict = verdict_of_exposing(precision, plan, output);
    return verdict.is_right ? std::string() : fault_text(verdict);
  }

  // On the programs that a picture is made with, which are built here if need be.
  Verdict verdict_of_exposing(Precision precision, const RenderPlan& plan, const OutputFormat& output) {
    const Work work = work_for(precision);
    const cl::Program develop = develop_program(work, plan, output);
    if (plan.blocks.empty()) return {};  // nothing is computed
    DeviceMemory memory(context_, info_);
    const DeviceLight& light = light_of(work, plan, memory);
    expose_program(work, plan, light);
    if (!options_.tests_itself) return {};
    const TestedPrograms tested{
        precision,
        {{"expose", options_of_exposing(work, plan, light)}, {"develop", options_of_developing(work, plan, output)}},
        kernels_make_codes(plan.capture, output) ? "codes" : "light"};
    return known_or_tested(tested, [&] {
      return self_test(plan.capture, precision, output, {!plan.map->mixed.empty(), plan.map->has_delays()},
                       [&](const RenderPlan& scene, CaptureSource& source, const OutputFormat& format) {
                         const Rectangle whole = Rectangle::whole(scene.capture.shape);
                         Rendered rendered;
                         expose_and_develop(work, {scene, source, format, whole, {}}, develop, rendered);
                         return std::move(rendered.picture);
                       });
    });
  }

  template <typename Test>
  Verdict known_or_tested(const TestedPrograms& tested, Test test) {
    const std::string key = tested.text();
    if (const auto known = known_verdicts_.find(key); known != known_verdicts_.end()) return known->second;
    const auto was_built = [&](const auto& each) { return programs_->was_built(each.name, each.options); };
    std::optional<Verdict> verdict;
    if (std::ranges::none_of(tested.programs, was_built)) verdict = verdicts_.find(tested);
    if (!verdict) {
      verdict = test();
      programs_->save_new_binaries();
      verdicts_.keep(tested, *verdict);
    }
    return known_verdicts_.emplace(key, *verdict).first->second;
  }

  // The middle one needs all samples of a pixel side by side: the processor has them there.
  Rendered combine(const Request& request) {
    const auto by_processor = [&] {
      RenderControl control = request.control;
      control.rectangle = request.rectangle;
      return CombiningRenderer().render(request.plan, request.source, request.output, control);
    };
    if (request.plan.combine == Combine::median || request.plan.blocks.empty()) return by_processor();
    return in_turn([&] {
      const SampleCombiner combining(request.plan, sample_gains(request.plan, request.source.timeline()));
      if (combining.scales() && !info_.has_double && !combining.has_normal_products()) return by_processor();
      const Verdict verdict = verdict_of_combining(combining, request.plan);
      if (!verdict.is_right && !request.control.takes_wrong) {
        Rendered rendered = by_processor();
        rendered.warnings.push_back(
            format("{} combines light wrongly (self-test: {}): the processor did it", info_.name, fault_text(verdict)));
        return rendered;
      }
      Rendered rendered;
      rendered.precision = Precision::double_;
      rendered.passed_self_test = verdict.is_right;
      combine_and_develop(combining, request, rendered);
      programs_->save_new_binaries();
      return rendered;
    });
  }

  [[nodiscard]] std::string options_of_combining(const Work& work, const RenderPlan& plan,
                                                 const SampleCombiner& combining) const {
    return expose_options(work, plan.capture, "NUTIK_LIGHT_LINEAR", false) + combining.options() +
           fault_of(work.precision);
  }

  Verdict verdict_of_combining(const SampleCombiner& combining, const RenderPlan& plan) {
    if (!options_.tests_itself) return {};
    const Work work = work_for(combining.precision_on(info_));
    const TestedPrograms tested{
        work.precision, {{"combine", options_of_combining(work, plan, combining)}}, "combined light"};
    return known_or_tested(tested, [&] {
      return self_test_combining(plan, combining.scales(),
                                 [&](const RenderPlan& scene, CaptureSource& source, const OutputFormat& format) {
                                   const Rectangle whole = Rectangle::whole(scene.capture.shape);
                                   Rendered rendered;
                                   combine_and_develop(SampleCombiner(scene, sample_gains(scene, source.timeline())),
                                                       {scene, source, format, whole, {}}, rendered);
                                   return std::move(rendered.picture);
                                 });
    });
  }

  void combine_and_develop(const SampleCombiner& combining, const Request& request, Rendered& rendered) {
    const RenderPlan& plan = request.plan;
    const Work work = work_for(combining.precision_on(info_));
    DeviceMemory memory(context_, info_);
    std::vector<ExposedBand> bands = bands_of(work, request, memory, rendered.statistics);
    const RenderMemory shares = memory_for(request, work.precision);
    const cl::Buffer light = memory.upload(combining.light());
    CombineKernel kernel(cl::Kernel(
        programs_->get("combine", kernel_source("combine"), options_of_combining(work, plan, combining)), "combine"));
    BlockKernel over_blocks{combining.slices(info_, shares.slice_bytes)};
    over_blocks.tables = [&](const TableSlice& slice) { return combining.tables(slice, memory); };
    over_blocks.launch = [&](const cl::Buffer& chunk, const cl::Buffer& entries, const SliceTables& tables,
                             const ExposedBand& band, const ExposeLaunch& launch) {
      return kernel(items(kernel, queue_, work.shape, launch.tile_count), chunk, entries, tables.parts, tables.gains,
                    light, band.map.tiles, band.map.of_tile, band.map.of_lane, band.sums, tables.gain_rows, launch);
    };
    rendered.picture = Picture({request.rectangle.width, request.rectangle.height, plan.capture.shape.channels},
                               request.output.type, request.output.white_code);
    const CombinedPicture to{request.output, request.rectangle, rendered.picture, rendered.saturation};
    Exposer exposer(device(), work, {plan, {}, every_function(plan)}, request.source, shares, std::move(over_blocks),
                    memory, rendered.statistics);
    exposer.expose(bands, request.control, [&](const ExposedBand& band) { combining.develop(band, queue_, to); });
    rendered.statistics.device_bytes = memory.max_bytes();
  }

  [[nodiscard]] ExposingDevice device() { return {info_, queue_, *feed_, options_.last_block_first}; }

  // What the exposures for a picture have in common: of its plan, and of light that is kept for it.
  struct Exposing {
    const Work& work;
    const Request& request;
    const DeviceLight& light;
    const RenderMemory& shares;
    DeviceMemory& memory;
    RenderStatistics& statistics;
  };

  void expose(const Exposing& in, const ExposedPlan& what, std::span<ExposedBand> bands,
              const Exposer::Develop& develop) {
    RenderControl control = in.request.control;
    if (&what.plan != &in.request.plan) control.progress = {};  // sums that are made to be kept
    ExposeKernel kernel(cl::Kernel(expose_program(in.work, what.plan, in.light), "expose"));
    // Every argument is a buffer, though it may not be read.
    const cl::Buffer exposes = in.memory.upload(what.exposes);
    const cl::Buffer& kept = what.kept.entries.empty() ? in.light.values : what.kept.sums;
    BlockKernel over_blocks{cut_tables(what.plan, TableNumbers::of(in.work.precision), info_, in.shares.slice_bytes)};
    over_blocks.tables = [&](const TableSlice& slice) {
      return columns_->slice(what.plan, slice, in.work.precision, in.work.shape.table_rows(), in.memory,
                             in.statistics.table_bytes_written, control.stop);
    };
    over_blocks.launch = [&](const cl::Buffer& chunk, const cl::Buffer& entries, const SliceTables& tables,
                             const ExposedBand& band, const ExposeLaunch& launch) {
      return kernel(items(kernel, queue_, in.work.shape, launch.tile_count), chunk, entries, tables.parts, tables.gains,
                    tables.weights, tables.boundaries, band.map.tiles, band.map.of_tile, band.map.of_lane, exposes,
                    in.light.values, kept, band.bundles, band.sums, launch);
    };
    Exposer exposer(device(), in.work, what, in.request.source, in.shares, std::move(over_blocks), in.memory,
                    in.statistics);
    exposer.expose(bands, control, develop);
  }

  void expose_and_develop(const Work& work, const Request& request, const cl::Program& develop, Rendered& rendered) {
    const RenderPlan& plan = request.plan;
    DeviceMemory memory(context_, info_);
    std::vector<ExposedBand> bands = bands_of(work, request, memory, rendered.statistics);
    Developer developer(work, plan, request.output, request.rectangle, develop, queue_, *lookups_, memory);
    const auto develop_band = [&](const ExposedBand& exposed) { developer.develop(exposed); };
    if (plan.blocks.empty()) {
      develop_dark(work, plan, bands, memory, develop_band);
    } else {
      const RenderMemory shares = memory_for(request, work.precision);
      const Exposing in{work, request, light_of(work, plan, memory), shares, memory, rendered.statistics};
      const auto expose_in = [&](const ExposedPlan& what, std::span<ExposedBand> exposed,
                                 const Exposer::Develop& done) { expose(in, what, exposed, done); };
      if (&request.source == resident_) {
        const auto whole_picture = [&](const RenderPlan& of_light) {
          const Rectangle whole = Rectangle::whole(of_light.capture.shape);
          return bands_of(work, {of_light, request.source, request.output, whole, request.control}, memory,
                          rendered.statistics);
        };
        incremental_.expose({expose_in, whole_picture, info_, queue_, memory, rendered.statistics}, plan,
                            request.source, work.precision, shares, bands, develop_band);
      } else {
        expose_in({plan, {}, every_function(plan)}, bands, develop_band);
      }
    }
    rendered.picture = developer.take_picture();
    rendered.saturation = developer.saturation();
    rendered.statistics.develop_ms = developer.develop_ms();
    rendered.statistics.device_bytes = memory.max_bytes();
  }

  // Sums of nothing are 0 in every arithmetic.
  void develop_dark(const Work& work, const RenderPlan& plan, std::span<ExposedBand> bands, DeviceMemory& memory,
                    const Exposer::Develop& develop) {
    for (ExposedBand& each : bands) {
      const DeviceMemory::Scope scope(memory);
      const std::uint64_t bytes = sums_bytes(each.band.sum_tiles, plan.capture.shape.channels, work.precision);
      each.sums = memory.allocate(bytes, CL_MEM_READ_WRITE);
      queue_.enqueueFillBuffer(each.sums, std::uint8_t{0}, 0, bytes);
      develop(each);
      each.sums = {};
    }
  }

  [[nodiscard]] Work work_for(Precision precision) const {
    return {precision, work_shape(options_, precision, info_), options_.use_fma && has_fma(device_, precision)};
  }

  const DeviceLight& light_of(const Work& work, const RenderPlan& plan, DeviceMemory& memory) {
    const bool permutes =
        work.shape.lanes == kLightPieces && options_.permutes_pieces.value_or(info_.native_float_lanes >= kLightPieces);
    const bool has_copies = work.shape.table_copies > 0;
    const bool looks_up_bytes = options_.looks_up_bytes.value_or(info_.permutes_bytes) && work.has_fma &&
                                work.shape.lanes == 16 && work.shape.item_pixels == kTilePixels && !has_copies;
    return lookups_->light(plan, work.precision, {permutes, has_copies, looks_up_bytes}, memory);
  }

  [[nodiscard]] std::string fault_of(Precision precision) const {
    const auto fault = options_.faults.find(precision);
    return fault == options_.faults.end() ? std::string() : " " + fault->second;
  }

  [[nodiscard]] std::string options_of_exposing(const Work& work, const RenderPlan& plan,
                                                const DeviceLight& light) const {
    return expose_options(work, plan.capture, light.kind, plan.map->has_delays(), light.has_byte_tables) +
           fault_of(work.precision);
  }

  [[nodiscard]] std::string options_of_developing(const Work& work, const RenderPlan& plan,
                                                  const OutputFormat& output) const {
    return develop_options(work, plan.capture, output, !plan.map->mixed.empty(), plan.map->has_delays()) +
           fault_of(work.precision);
  }

  cl::Program expose_program(const Work& work, const RenderPlan& plan, const DeviceLight& light) {
    return programs_->get("expose", kernel_source("expose"), options_of_exposing(work, plan, light));
  }

  cl::Program develop_program(const Work& work, const RenderPlan& plan, const OutputFormat& output) {
    return programs_->get("develop", kernel_source("develop"), options_of_developing(work, plan, output));
  }

  // The bands of a rectangle, without sums.
  std::vector<ExposedBand> bands_of(const Work& work, const Request& request, DeviceMemory& memory,
                                    RenderStatistics& statistics) {
    std::vector<ExposedBand> bands;
    for (const Band& band : cut_picture(request.plan.capture.shape, request.rectangle, work.precision, info_,
                                        kBandBytes, request.plan.map->mixed_tiles)) {
      const DeviceMap& map = lookups_->map(request.plan.map, band, memory, statistics.map_bytes_written);
      bands.push_back({band, map, {}, {}});
    }
    return bands;
  }

  OpenClOptions options_;
  cl::Device device_;
  DeviceInfo info_;
  cl::Context context_;
  cl::CommandQueue queue_;
  std::unique_ptr<ProgramStore> programs_;
  VerdictStore verdicts_;
  std::map<std::string, Verdict> known_verdicts_;  // by TestedPrograms::text()
  bool announced_ = false;
  std::unique_ptr<BlockFeed> feed_;
  const CaptureSource* resident_ = nullptr;
  IncrementalExposer incremental_;
  std::unique_ptr<GainColumns> columns_;
  std::unique_ptr<DeviceLookups> lookups_;
  std::mutex turn_;  // at the device: all that follows from a plan's choice of arithmetic on
};

OpenClRenderer::OpenClRenderer(const OpenClOptions& options) {
  try {
    implementation_ = std::make_unique<Implementation>(options);
  } catch (const cl::Error& error) {
    throw device_failed(error, "the OpenCL device cannot be started");
  }
}

OpenClRenderer::~OpenClRenderer() = default;

void OpenClRenderer::prepare(const RenderPlan& plan, const OutputFormat& output) {
  implementation_->prepare(plan, output);
}

Rendered OpenClRenderer::render_part(const RenderPlan& plan, CaptureSource& source, const OutputFormat& output,
                                     const Rectangle& rectangle, const RenderControl& control) {
  return implementation_->render({plan, source, output, rectangle, control});
}

std::span<const Precision> OpenClRenderer::precisions() const { return precisions_of(info()); }

void OpenClRenderer::keep_resident(const CaptureSource* source) { implementation_->keep_resident(source); }

std::string OpenClRenderer::name() const { return info().name; }

const DeviceInfo& OpenClRenderer::info() const { return implementation_->info(); }

std::string OpenClRenderer::fault_in(Precision precision, const RenderPlan& plan, const OutputFormat& output) {
  return implementation_->fault_in(precision, plan, output);
}

}  // namespace nutik
