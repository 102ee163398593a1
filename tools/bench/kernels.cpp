// How fast the kernels read a capture, against the limit of the memory they read it from.
//
//   bench_kernels [--width N] [--height N] [--samples N] [--runs N] [--device I] [--csv FILE] [--quick]
//                 [--precision P] [--transfer T] [--bits 8|16]
//                 [--item-pixels N] [--item-tiles N] [--lanes N] [--group-items N]
//                 [--rows-at-once N] [--table-copies N]
//
// Needs only OpenCL and a compiler. Kernel times are the device's own (profiling events), medians of
// several runs; the limit is measured in the same run: memory read by all cores where the device shares
// the host's memory, else a copy within the device (bytes read and written).
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "capture/format.hpp"
#include "device_bandwidth.hpp"
#include "harness.hpp"
#include "memory_bandwidth.hpp"
#include "opencl/device.hpp"
#include "opencl/opencl_renderer.hpp"
#include "render/reference_renderer.hpp"
#include "synthetic_capture.hpp"

namespace nutik::bench {
namespace {

struct Settings {
  std::uint32_t width = 1920;
  std::uint32_t height = 1080;
  std::uint64_t samples = 240;
  int runs = 7;
  std::size_t device = 0;
  std::string csv;
  std::string precision, transfer;  // the only ones; empty: all
  std::uint32_t bits = 0;          // the only ones; 0: 8 and 16
  bool quick = false;
  int table_copies = -1;  // of light beside a work-group; -1: as the device's kind suggests
  OpenClOptions options;  // how the work is cut, for tuning; 0: as the device's kind suggests
};

Settings parse(int argc, char** argv) {
  Settings settings;
  OpenClOptions& options = settings.options;
  read_options(argc, argv, "kernels.cpp",
               {{"--width", &settings.width},
                {"--height", &settings.height},
                {"--samples", &settings.samples},
                {"--runs", &settings.runs},
                {"--device", &settings.device},
                {"--csv", &settings.csv},
                {"--precision", &settings.precision},
                {"--transfer", &settings.transfer},
                {"--bits", &settings.bits},
                {"--item-pixels", &options.item_pixels},
                {"--item-tiles", &options.item_tiles},
                {"--lanes", &options.lanes},
                {"--group-items", &options.group_items},
                {"--rows-at-once", &options.rows_at_once},
                {"--table-copies", &settings.table_copies},
                {"--quick", &settings.quick}});
  settings.runs = std::max(settings.runs, 1);
  if (settings.table_copies >= 0) options.table_copies = static_cast<std::uint32_t>(settings.table_copies);
  return settings;
}

enum class Regions { uniform, aligned, random, soft, delayed };

const char* name_of(Regions regions) {
  switch (regions) {
    case Regions::uniform: return "uniform";
    case Regions::aligned: return "aligned";
    case Regions::random: return "random 256";
    case Regions::soft: return "soft 2";
    case Regions::delayed: return "row delays";
  }
  return "";
}
const char* name_of(Content content) {
  switch (content) {
    case Content::dense: return "dense";
    case Content::rows: return "rows";
    case Content::records: return "records";
    case Content::still: return "still";
  }
  return "";
}

constexpr Share kHalves[] = {{0, kWholeShare / 2}, {1, kWholeShare - kWholeShare / 2}};

Mask mask_for(const Shape& shape, Regions regions) {
  Mask mask = Mask::uniform(shape.width, shape.height, 0);
  std::uint64_t state = 12345;
  for (std::size_t pixel = 0; pixel < mask.tags.size(); ++pixel) {
    const std::size_t x = pixel % shape.width, y = pixel / shape.width;
    state = state * 6364136223846793005u + 1442695040888963407u;
    if (regions == Regions::aligned) mask.tags[pixel] = static_cast<std::uint8_t>((x / 64 + y / 64) % 4);
    if (regions == Regions::random) mask.tags[pixel] = static_cast<std::uint8_t>(state >> 56);
    if (regions == Regions::soft) mask.mixed.add(pixel, kHalves);
  }
  return mask;
}

// Every function live over the whole capture, each its own ramp.
FunctionSet functions_for(Regions regions, std::int64_t duration_ns, std::uint32_t points) {
  const int count = regions == Regions::random ? 256 : regions == Regions::aligned ? 4 : regions == Regions::soft ? 2 : 1;
  FunctionSet functions;
  for (int tag = 0; tag < count; ++tag) {
    std::vector<ControlPoint> control;
    for (std::uint32_t i = 0; i < points; ++i) {
      control.push_back(
          {duration_ns * i / points, 0.5 + 0.5 * ((i * 7 + static_cast<std::uint32_t>(tag)) % 11) / 11.0});
    }
    functions.emplace(static_cast<std::uint8_t>(tag), GainFunction(std::move(control)));
  }
  return functions;
}

// The plan of a capture in which every sample is live. Delays go down the rows, over a tenth of it.
RenderPlan plan_for(const SyntheticCapture& capture, Regions regions) {
  const Shape shape = capture.format().shape;
  const std::int64_t duration_ns = capture.timeline().duration_ns();
  PlanOptions options;
  options.unmapped_is_zero = true;
  if (regions == Regions::delayed) {
    options.delays = std::make_shared<const DelayMap>(DelayMap::by_rows(shape, {std::int64_t{0}, duration_ns / 10}));
  }
  return make_plan(capture, functions_for(regions, duration_ns, 5), mask_for(shape, regions), options);
}

struct Case {
  Content content;
  Precision precision;
  Transfer transfer;
  std::uint32_t code_bytes;
  Regions regions;
};

struct Measurement {
  double read_ms;
  double expose_ms;
  double develop_ms;
  std::uint64_t bytes;
};

Measurement measure(OpenClRenderer& renderer, const RenderPlan& plan, SyntheticCapture& capture, int runs) {
  std::vector<double> read, expose, develop;
  std::uint64_t bytes = 0;
  for (int run = -1; run < runs; ++run) {  // the first warms up
    const RenderStatistics took = renderer.render(plan, capture, {ValueType::code8, 255}).statistics;
    if (run < 0) continue;
    read.push_back(took.read_ms);
    expose.push_back(took.expose_ms);
    develop.push_back(took.develop_ms);
    bytes = took.payload_bytes;
  }
  return {median(read), median(expose), median(develop), bytes};
}

// The worst difference from the reference on a small capture of the same kind, in S.
double check(OpenClRenderer& renderer, const Case& one) {
  CaptureFormat format;
  format.shape = {72, 40, 3};
  format.code_bytes = one.code_bytes;
  format.white_code = one.code_bytes == 1 ? 255 : 4095;
  format.transfer = one.transfer;
  SyntheticCapture capture(format, 130, 64, one.content);
  const RenderPlan plan = plan_for(capture, one.regions);
  const Picture a = renderer.render(plan, capture, {ValueType::light64, 0}).picture;
  const Picture b = ReferenceRenderer().render(plan, capture, {ValueType::light64, 0}).picture;
  double worst = 0.0;
  for (std::uint64_t i = 0; i < a.shape.value_count(); ++i) {
    const double scale = plan.error_scale(i / 3);
    const double difference = std::abs(a.values<double>()[i] - b.values<double>()[i]) / scale;
    worst = difference > worst || difference != difference ? difference : worst;
  }
  return worst;
}

int run(const Settings& settings) {
  const std::vector<DeviceInfo> devices = list_devices();
  const DeviceInfo& device = devices.at(settings.device);
  std::printf("%s, %u compute units, %s; %u x %u x 3, %llu samples, medians of %d\n", device.name.c_str(),
              device.compute_units, device.driver_version.c_str(), settings.width, settings.height,
              static_cast<unsigned long long>(settings.samples), settings.runs);

  std::vector<Case> cases;
  for (const Precision precision : precisions_of(device)) {
    for (const Transfer transfer : {Transfer::linear(), Transfer::srgb()}) {
      for (const Content content : {Content::dense, Content::rows, Content::records, Content::still}) {
        cases.push_back({content, precision, transfer, 1, Regions::uniform});
      }
      for (const Regions regions : {Regions::aligned, Regions::random, Regions::soft, Regions::delayed}) {
        cases.push_back({Content::dense, precision, transfer, 1, regions});
      }
      cases.push_back({Content::dense, precision, transfer, 2, Regions::uniform});
    }
  }
  if (settings.quick) {
    std::erase_if(cases, [](const Case& one) {
      return one.content != Content::dense || one.regions != Regions::uniform;
    });
  }

  std::erase_if(cases, [&](const Case& one) {
    return (!settings.precision.empty() && to_text(one.precision) != settings.precision) ||
           (settings.bits != 0 && settings.bits != one.code_bytes * 8) ||
           (!settings.transfer.empty() && one.transfer.text() != settings.transfer);
  });

  std::printf(
      "limit: %s, measured before and after each case\n",
      device.shares_host_memory ? "memory read by all cores" : "copy within the device, read and write");
  if (!device.shares_host_memory) {
    const TransferRates rates = transfer_rates(settings.device, 256u << 20);
    std::printf("to the device %.1f GB/s, pinned %.1f; back %.1f, pinned %.1f\n", rates.upload * 1e-9,
                rates.pinned_upload * 1e-9, rates.readback * 1e-9, rates.pinned_readback * 1e-9);
  }
  std::printf("\n");
  // The capture's own memory is measured: on a virtual machine one allocation may be read at twice the rate of another,
  // and the rate may change from minute to minute. Small captures say nothing: they fit caches.
  double last_limit = 0.0;
  const auto measure_limit = [&](const SyntheticCapture& capture) {
    const auto memory = capture.memory();
    if (memory.size() < (256u << 20)) return last_limit;
    last_limit = device.shares_host_memory ? read_bandwidth(memory)
                                           : device_copy_bandwidth(settings.device, memory.size() / 2);
    return last_limit;
  };
  std::printf("%-8s %-11s %-7s %-5s %-11s %9s %8s %8s %7s %9s %9s %10s\n", "tiles", "prec.", "light", "bits",
              "regions", "expose ms", "GB/s", "limit", "share", "dev. ms", "read ms", "worst / S");
  std::ofstream csv(settings.csv);
  csv << "device,tiles,precision,light,bits,regions,expose_ms,bytes,gb_per_s,limit_gb_per_s,develop_ms,"
         "read_ms,worst\n";
  for (const Case& one : cases) {
    CaptureFormat format;
    format.shape = {settings.width, settings.height, 3};
    format.code_bytes = one.code_bytes;
    format.white_code = one.code_bytes == 1 ? 255 : 4095;
    format.transfer = one.transfer;
    SyntheticCapture capture(format, settings.samples, 64, one.content);
    const RenderPlan plan = plan_for(capture, one.regions);
    OpenClOptions options = settings.options;
    options.device = settings.device;
    options.precision = one.precision;
    options.chunk_bytes = 4ull << 30;
    OpenClRenderer renderer(options);
    const double worst = check(renderer, one);
    const double limit_before = measure_limit(capture);
    const Measurement measured = measure(renderer, plan, capture, settings.runs);
    const double limit = (limit_before + measure_limit(capture)) / 2;
    // Some drivers report kernel times of zero: what follows from them is left out.
    const bool is_timed = measured.expose_ms > 0;
    const auto timed = [&](double figure, int digits, const char* otherwise) {
      return is_timed ? nutik::format("{:.{}f}", figure, digits) : std::string(otherwise);
    };
    const double rate = is_timed ? static_cast<double>(measured.bytes) / measured.expose_ms * 1e3 : 0.0;
    std::printf("%-8s %-11s %-7s %-5u %-11s %9s %8s %8.1f %7s %9s %9.2f %10.2g\n", name_of(one.content),
                to_text(one.precision).c_str(), one.transfer.text().c_str(), one.code_bytes * 8,
                name_of(one.regions), timed(measured.expose_ms, 2, "not timed").c_str(),
                timed(rate * 1e-9, 2, "-").c_str(), limit * 1e-9,
                (limit > 0 ? timed(rate / limit, 2, "-") : "-").c_str(),
                timed(measured.develop_ms, 2, "-").c_str(), measured.read_ms, worst);
    std::fflush(stdout);
    csv << device.name << ',' << name_of(one.content) << ',' << to_text(one.precision) << ','
        << one.transfer.text() << ',' << one.code_bytes * 8 << ',' << name_of(one.regions) << ','
        << timed(measured.expose_ms, 4, "") << ',' << measured.bytes << ',' << timed(rate * 1e-9, 4, "")
        << ',' << limit * 1e-9 << ',' << timed(measured.develop_ms, 4, "") << ',' << measured.read_ms << ','
        << worst << '\n';
  }
  return 0;
}

}  // namespace
}  // namespace nutik::bench

int main(int argc, char** argv) {
  nutik::prepare_for_pocl();  // as the program does
  try {
    return nutik::bench::run(nutik::bench::parse(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_kernels: %s\n", error.what());
    return 1;
  }
}
