// What a moved control point costs beside a first render, and beside the kernels' own time.
//
//   bench_live [--width N] [--height N] [--samples N] [--functions N] [--runs N] [--device I] [--precision P]
//
// One capture stays where kernels read it, as in a window: 1280 x 720, 240 samples of 8 bits, each pixel's changes a
// tenth of them, 64 functions in squares of the picture. Each run renders with a point moved, with the mask painted,
// and as it was: all in turns, so that what else the machine does hits them alike. A render is a plan and its
// picture, by the host's clock; the kernels by the device's own. Prints medians, and of each run the ratio of both.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness.hpp"
#include "opencl/opencl_renderer.hpp"
#include "render/plan_cache.hpp"
#include "synthetic_capture.hpp"

namespace nutik::bench {
namespace {

struct Settings {
  std::uint32_t width = 1280;
  std::uint32_t height = 720;
  std::uint64_t samples = 240;
  std::uint32_t functions = 64;
  int runs = 25;
  OpenClOptions options;
};

Settings parse(int argc, char** argv) {
  Settings settings;
  std::string precision;
  read_options(argc, argv, "live.cpp",
               {{"--width", &settings.width},
                {"--height", &settings.height},
                {"--samples", &settings.samples},
                {"--functions", &settings.functions},
                {"--runs", &settings.runs},
                {"--device", &settings.options.device},
                {"--precision", &precision}});
  settings.functions = std::clamp(settings.functions, 1u, kMaskValues);
  settings.runs = std::max(settings.runs, 1);
  if (!precision.empty()) settings.options.precision = parse_precision(precision);
  return settings;
}

// Squares of 64 pixels, each a function's; `shift` moves them.
Mask squares(const Settings& settings, std::uint32_t shift) {
  Mask mask = Mask::uniform(settings.width, settings.height, 0);
  for (std::uint32_t y = 0; y < settings.height; ++y) {
    for (std::uint32_t x = 0; x < settings.width; ++x) {
      mask.tags[std::size_t{y} * settings.width + x] =
          static_cast<std::uint8_t>((x / 64 + y / 64 * 20 + shift) % settings.functions);
    }
  }
  return mask;
}

GainFunction ramp(const Timeline& timeline, std::uint32_t tag, std::uint32_t moved) {
  const std::int64_t duration_ns = timeline.duration_ns();
  return GainFunction({{0, 0.2},
                       {duration_ns / 3 + moved * 1'000'000, 0.5 + 0.005 * tag},
                       {duration_ns / 2, 0.9},
                       {duration_ns * 3 / 4, 0.1},
                       {duration_ns, 0.6}});
}

struct Times {
  std::vector<double> wall_ms, kernel_ms, share;
  RenderStatistics last;
};

int run(const Settings& settings) {
  CaptureFormat format;
  format.shape = {settings.width, settings.height, 3};
  SyntheticCapture capture(format, settings.samples, 64, Content::records);
  const OutputFormat output{ValueType::code8, 255};
  OpenClRenderer renderer(settings.options);
  renderer.keep_resident(&capture);
  std::optional<PlanCache> plans(std::in_place);
  FunctionSet functions;
  for (std::uint32_t tag = 0; tag < settings.functions; ++tag) {
    functions.emplace(static_cast<std::uint8_t>(tag), ramp(capture.timeline(), tag, 0));
  }
  Mask mask = squares(settings, 0);
  Precision precision{};
  const auto render = [&](Times& times) {
    const auto start = std::chrono::steady_clock::now();
    const Rendered rendered = renderer.render(plans->plan(capture, functions, mask, {}), capture, output);
    const double wall_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    const double kernel_ms = rendered.statistics.expose_ms + rendered.statistics.develop_ms;
    times.wall_ms.push_back(wall_ms);
    times.kernel_ms.push_back(kernel_ms);
    if (kernel_ms > 0) times.share.push_back(wall_ms / kernel_ms);
    times.last = rendered.statistics;
    precision = rendered.precision;
  };
  const auto print = [](const char* name, const Times& times) {
    std::printf("%-28s %9.2f ms, ", name, median(times.wall_ms));
    if (times.share.empty()) {
      std::printf("kernels not timed by the driver");
    } else {
      std::printf("kernels %9.2f ms, %6.3f x", median(times.kernel_ms), median(times.share));
    }
    std::printf("; wrote %llu bytes of tables, %llu of the map\n",
                static_cast<unsigned long long>(times.last.table_bytes_written),
                static_cast<unsigned long long>(times.last.map_bytes_written));
  };
  Times first, cold, moved, painted, again;
  render(first);
  for (int run = 0; run < settings.runs; ++run) {
    const auto move = static_cast<std::uint32_t>(run + 1);
    const auto tag = static_cast<std::uint8_t>(move % settings.functions);
    functions.at(tag) = ramp(capture.timeline(), tag, move);
    render(moved);
    mask = squares(settings, move);
    render(painted);
    render(again);
    plans.emplace();  // as if nothing had been rendered before, but for the kernels
    render(cold);
  }
  std::printf("%s, %s precision, %u x %u x 3, %llu samples (%.1f MB read), %u functions; medians of %d\n",
              renderer.name().c_str(), to_text(precision).c_str(), settings.width, settings.height,
              static_cast<unsigned long long>(settings.samples),
              static_cast<double>(first.last.payload_bytes) * 1e-6, settings.functions, settings.runs);
  print("first, with its kernels", first);
  print("a new plan", cold);
  print("a moved control point", moved);
  print("a painted mask", painted);
  print("the same again", again);
  return 0;
}

}  // namespace
}  // namespace nutik::bench

int main(int argc, char** argv) {
  try {
    return nutik::bench::run(nutik::bench::parse(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_live: %s\n", error.what());
    return 1;
  }
}
