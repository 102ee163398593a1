// What a change costs that somebody waits for, against what a window that answers in time may take.
//
//   bench_live [--part edits|drag|scrub|long|batch] [--width N] [--height N] [--samples N] [--runs N] [--device I]
//              [--precision P]
//
//   edits   64 functions in squares of the picture, a tenth of all samples: a point moved, the mask painted, the same
//           again, all made anew. Beside the kernels' own time, which nothing else should exceed
//   drag    five functions in columns, everything changes all the time: the control point with the longest neighbours
//           is moved (target: 40 ms in the median, 60 ms at the 95th percentile)
//   scrub   the same capture: a boxcar of 10 ms is moved (20 ms)
//   long    10 000 samples at 1000 a second: boxcars of 5 s beside some of 10 ms, in turns, over a capture of which no
//           sums are there, and twice more; timed where they are (twice as long)
//   batch   10 000 samples of 480 x 270, a tenth of them all: forty boxcars of 5 s beside forty of 10 ms, each forty
//           from nothing, in turns (1.6 times as long). A run is such a pair: --runs 5 is enough
//
// The first three have 240 samples of 1280 x 720, `long` 640 x 360, all 8 bits, srgb, kept where kernels read them. A
// time is that of a plan and its whole picture, by the host's clock; processor time is that of all threads, which other
// programs hardly change; kernels' are by the device's own.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness.hpp"
#include "opencl/device.hpp"
#include "opencl/opencl_renderer.hpp"
#include "render/plan_cache.hpp"
#include "synthetic_capture.hpp"

namespace nutik::bench {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::uint32_t kRate = 1000;

struct Settings {
  std::string part;  // all if empty
  std::uint32_t width = 0, height = 0;
  std::uint64_t samples = 0;
  int runs = 40;
  OpenClOptions options;
};

Settings parse(int argc, char** argv) {
  Settings settings;
  std::string precision;
  read_options(argc, argv, "live.cpp",
               {{"--part", &settings.part},
                {"--width", &settings.width},
                {"--height", &settings.height},
                {"--samples", &settings.samples},
                {"--runs", &settings.runs},
                {"--device", &settings.options.device},
                {"--precision", &precision}});
  settings.runs = std::max(settings.runs, 1);
  if (!precision.empty()) settings.options.precision = parse_precision(precision);
  return settings;
}

// Renders of one kind.
struct Times {
  std::vector<double> wall_ms, processor_ms, kernel_ms;
  RenderStatistics last;
  std::uint64_t made_sums = 0;

  void print(const char* name) const {
    std::vector<double> sorted = wall_ms;
    std::ranges::sort(sorted);
    std::printf(
        "  %-26s %8.2f ms, %8.2f at the 95th percentile; of processors %8.2f, of kernels %8.2f; "
        "%llu blocks read, %llu sums kept; %llu sums made in all\n",
        name, median(wall_ms), sorted[sorted.size() * 95 / 100], median(processor_ms), median(kernel_ms),
        static_cast<unsigned long long>(last.blocks), static_cast<unsigned long long>(last.kept_sums),
        static_cast<unsigned long long>(made_sums));
  }
};

// A capture that stays where kernels read it, as in a window.
class Scene {
 public:
  Scene(const Settings& settings, const char* part, const Shape& shape, std::uint64_t samples,
        Content content)
      : settings_(settings),
        capture_(format_of(settings, shape), settings.samples != 0 ? settings.samples : samples, 64, content,
                 kRate),
        renderer_(settings.options) {
    renderer_.keep_resident(&capture_);
    const Shape& made = capture_.format().shape;
    std::printf("%s: %u x %u x %u, %llu samples, %.0f MB; %s, medians of %d\n", part, made.width, made.height,
                made.channels, static_cast<unsigned long long>(capture_.timeline().sample_count()),
                static_cast<double>(capture_.memory().size()) * 1e-6, renderer_.name().c_str(),
                settings.runs);
  }
  ~Scene() { renderer_.keep_resident(nullptr); }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  void render(Times* times = nullptr) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t start_clock = std::clock();
    const Rendered rendered =
        renderer_.render(plans_->plan(capture_, functions, mask, {}), capture_, {ValueType::code8, 255});
    if (times == nullptr) return;
    times->wall_ms.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    times->processor_ms.push_back(1e3 * static_cast<double>(std::clock() - start_clock) / CLOCKS_PER_SEC);
    times->kernel_ms.push_back(rendered.statistics.expose_ms + rendered.statistics.develop_ms);
    times->last = rendered.statistics;
    times->made_sums += rendered.statistics.made_sums;
  }
  void forget_plans() { plans_.emplace(); }
  // Plans, and all that is on the device.
  void forget() {
    forget_plans();
    renderer_.keep_resident(nullptr);
    renderer_.keep_resident(&capture_);
  }

  [[nodiscard]] std::uint32_t width() const { return capture_.format().shape.width; }
  [[nodiscard]] std::uint32_t height() const { return capture_.format().shape.height; }
  [[nodiscard]] std::int64_t duration_ns() const { return capture_.timeline().duration_ns(); }
  [[nodiscard]] int runs() const { return settings_.runs; }

  // Each pixel's tag.
  void paint(const std::function<std::uint32_t(std::uint32_t x, std::uint32_t y)>& tag) {
    mask = Mask::uniform(width(), height(), 0);
    for (std::uint32_t y = 0; y < height(); ++y) {
      for (std::uint32_t x = 0; x < width(); ++x) {
        mask.tags[std::size_t{y} * width() + x] = static_cast<std::uint8_t>(tag(x, y));
      }
    }
  }

  FunctionSet functions;
  Mask mask;

 private:
  static CaptureFormat format_of(const Settings& settings, const Shape& shape) {
    CaptureFormat format;
    format.shape = {settings.width != 0 ? settings.width : shape.width,
                    settings.height != 0 ? settings.height : shape.height, 3};
    return format;
  }

  const Settings& settings_;
  SyntheticCapture capture_;
  OpenClRenderer renderer_;
  std::optional<PlanCache> plans_{std::in_place};
};

GainFunction ramp(std::int64_t duration_ns, std::uint32_t tag, std::uint32_t moved) {
  return GainFunction({{0, 0.2},
                       {duration_ns / 3 + moved * kMs, 0.5 + 0.005 * tag},
                       {duration_ns / 2, 0.9},
                       {duration_ns * 3 / 4, 0.1},
                       {duration_ns, 0.6}});
}

void edits(const Settings& settings) {
  constexpr std::uint32_t kFunctions = 64;
  Scene scene(settings, "edits", {1280, 720, 3}, 240, Content::records);
  for (std::uint32_t tag = 0; tag < kFunctions; ++tag) {
    scene.functions.emplace(static_cast<std::uint8_t>(tag), ramp(scene.duration_ns(), tag, 0));
  }
  const auto paint = [&](std::uint32_t shift) {
    scene.paint([&](auto x, auto y) { return (x / 64 + y / 64 * 20 + shift) % kFunctions; });
  };
  paint(0);
  scene.render();
  Times cold, moved, painted, again;
  for (int run = 0; run < scene.runs(); ++run) {
    const auto move = static_cast<std::uint32_t>(run + 1);
    const auto tag = static_cast<std::uint8_t>(move % kFunctions);
    scene.functions.at(tag) = ramp(scene.duration_ns(), tag, move);
    scene.render(&moved);
    paint(move);
    scene.render(&painted);
    scene.render(&again);
    scene.forget_plans();  // as if nothing had been rendered before, but for the kernels
    scene.render(&cold);
  }
  cold.print("a new plan");
  moved.print("a moved control point");
  painted.print("a painted mask");
  again.print("the same again");
}

void drag(const Settings& settings) {
  Scene scene(settings, "drag", {1280, 720, 3}, 240, Content::dense);
  scene.paint([&](auto x, auto) { return x * 5 / scene.width(); });
  for (std::uint32_t tag = 0; tag < 5; ++tag) {
    scene.functions.emplace(static_cast<std::uint8_t>(tag), ramp(scene.duration_ns(), tag, 0));
  }
  scene.render();
  scene.render();
  Times moved;
  for (int run = 1; run <= scene.runs(); ++run) {
    scene.functions.at(2) = ramp(scene.duration_ns(), 2, static_cast<std::uint32_t>(run % 40));
    scene.render(&moved);
  }
  moved.print("a dragged control point");
}

// Boxcars of one length, each a little later.
void move_boxcar(Scene& scene, std::int64_t length_ns, int run, Times* times, std::int64_t later_ns = 0) {
  const std::int64_t start_ns = (scene.duration_ns() - length_ns) * run / (2 * scene.runs()) + later_ns;
  scene.functions.insert_or_assign(0, GainFunction::boxcar(start_ns, start_ns + length_ns));
  scene.render(times);
}

void scrub(const Settings& settings) {
  Scene scene(settings, "scrub", {1280, 720, 3}, 240, Content::dense);
  scene.paint([](auto, auto) { return 0; });
  move_boxcar(scene, 10 * kMs, 0, nullptr);
  Times times;
  for (int run = 1; run <= scene.runs(); ++run) move_boxcar(scene, 10 * kMs, run, &times);
  times.print("a boxcar of 10 ms");
}

void long_boxcars(const Settings& settings) {
  Scene scene(settings, "long", {640, 360, 3}, 10'000, Content::dense);
  scene.paint([](auto, auto) { return 0; });
  move_boxcar(scene, 10 * kMs, 0, nullptr);
  Times first, second, brief, lasting, brief_again, lasting_again;
  move_boxcar(scene, scene.duration_ns() / 2, 0, &first);
  move_boxcar(scene, scene.duration_ns() / 2, 1, &second);
  for (int run = 2; run <= scene.runs() + 1; ++run) {
    move_boxcar(scene, 10 * kMs, run, &brief);
    move_boxcar(scene, scene.duration_ns() / 2, run, &lasting);
  }
  // A little later, so that functions are new ones; the first time makes sums that none before has wanted.
  for (const std::int64_t later_ns : {3 * kMs, 3 * kMs + 1000}) {
    const bool is_timed = later_ns != 3 * kMs;
    for (int run = 2; run <= scene.runs() + 1; ++run) {
      move_boxcar(scene, 10 * kMs, run, is_timed ? &brief_again : nullptr, later_ns);
      move_boxcar(scene, scene.duration_ns() / 2, run, is_timed ? &lasting_again : nullptr, later_ns);
    }
  }
  first.print("half of it, for once");
  second.print("and again: sums are made");
  brief.print("a boxcar of 10 ms");
  lasting.print("half of it");
  double all_brief = 0.0, all_lasting = first.wall_ms[0] + second.wall_ms[0];
  for (const double ms : brief.wall_ms) all_brief += ms;
  for (const double ms : lasting.wall_ms) all_lasting += ms;
  brief_again.print("10 ms, once more");
  lasting_again.print("half of it, once more");
  std::printf("  half of it beside 10 ms: %.2f in the median, %.2f of all %d with the sums that were made\n",
              median(lasting.wall_ms) / median(brief.wall_ms), all_lasting / all_brief, settings.runs);
  std::printf("  once more: %.2f in the median, %.2f of processor time, %.2f of the kernels'\n",
              median(lasting_again.wall_ms) / median(brief_again.wall_ms),
              median(lasting_again.processor_ms) / median(brief_again.processor_ms),
              median(lasting_again.kernel_ms) / median(brief_again.kernel_ms));
}

double total(const std::vector<double>& of) { return std::accumulate(of.begin(), of.end(), 0.0); }

void batch(const Settings& settings) {
  constexpr int kPictures = 40;
  Scene scene(settings, "batch", {480, 270, 3}, 10'000, Content::records);
  scene.paint([](auto, auto) { return 0; });
  const std::int64_t long_ns = scene.duration_ns() / 2;
  const auto forty = [&](std::int64_t length_ns) {
    Times times;
    scene.forget();
    for (int k = 0; k < kPictures; ++k) {
      const std::int64_t start_ns = long_ns / kPictures * k;
      scene.functions.insert_or_assign(0, GainFunction::boxcar(start_ns, start_ns + length_ns));
      scene.render(&times);
    }
    return times;
  };
  static_cast<void>(forty(10 * kMs));
  std::vector<double> brief_ms, lasting_ms, wall, processor;
  for (int run = 0; run < scene.runs(); ++run) {
    const Times brief = forty(10 * kMs), lasting = forty(long_ns);
    brief_ms.push_back(total(brief.wall_ms));
    lasting_ms.push_back(total(lasting.wall_ms));
    wall.push_back(lasting_ms.back() / brief_ms.back());
    processor.push_back(total(lasting.processor_ms) / total(brief.processor_ms));
  }
  std::printf(
      "  forty of 10 ms %8.1f ms, of half of it %8.1f ms: %.2f times as long, %.2f times the processor "
      "time\n",
      median(brief_ms), median(lasting_ms), median(wall), median(processor));
}

int run(const Settings& settings) {
  const std::pair<const char*, void (*)(const Settings&)> parts[]{
      {"edits", edits}, {"drag", drag}, {"scrub", scrub}, {"long", long_boxcars}, {"batch", batch}};
  bool is_known = settings.part.empty();
  for (const auto& [name, part] : parts) {
    if (!settings.part.empty() && settings.part != name) continue;
    is_known = true;
    part(settings);
  }
  if (!is_known) refuse(settings.part, "is no part", "live.cpp");
  return 0;
}

}  // namespace
}  // namespace nutik::bench

int main(int argc, char** argv) {
  nutik::prepare_for_pocl();  // as the program does
  try {
    return nutik::bench::run(nutik::bench::parse(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_live: %s\n", error.what());
    return 1;
  }
}
