// Whether exposing a video's frames goes on beside encoding them: each alone, and both.
//
//   bench_video CAPTURE.tik VIDEO [RUNS]      e.g. film.mkv (FFV1), film.mp4 (H.264)
//
// 24 frames a second of the capture, 180 degrees, at a tenth of its speed, at most 300 of them. Exposing alone throws
// its frames away, encoding alone takes them from memory. Prints the medians of the seconds and the slower one's
// share of both.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "capture/frame_times.hpp"
#include "harness.hpp"
#include "features/series/picture_queue.hpp"
#include "media/writers/video_writer.hpp"
#include "opencl/device.hpp"
#include "opencl/opencl_renderer.hpp"
#include "tik/reader.hpp"

namespace nutik {
namespace {

using bench::median;
using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kMaxFrames = 300;
constexpr Rational kRate{24, 1}, kSpeed{1, 10}, kAngle{180, 1};

template <typename Work>
double seconds_of(Work work) {
  const auto start = Clock::now();
  work();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

int run(const std::filesystem::path& capture, const std::filesystem::path& video, int runs) {
  tik::Reader reader(capture);
  OpenClRenderer renderer({});
  renderer.keep_resident(&reader);
  const FrameTimes times({0, 1}, kRate, kSpeed, kAngle);
  const std::uint64_t count = std::min(kMaxFrames, times.count_ending_by(reader.timeline().duration_ns()));
  const Shape shape = reader.format().shape;
  const Mask mask = Mask::uniform(shape.width, shape.height, 0);
  const OutputFormat format{ValueType::code8, 255};
  const auto expose = [&](std::uint64_t k) {
    FunctionSet functions;
    functions.emplace(0, GainFunction::boxcar(times.start_ns(k), times.end_ns(k)));
    return renderer.render(make_plan(reader, functions, mask, {}), reader, format).picture;
  };
  const auto open = [&] {
    return open_video_writer(video, {shape, format.type, format.white_code, reader.format().transfer, kRate},
                             video_codec_for(video, {}));
  };

  std::vector<double> exposing, encoding, both;
  std::vector<Picture> frames;
  for (int run = -1; run < runs; ++run) {  // the first warms up
    std::vector<Picture> made;
    const double alone = seconds_of([&] {
      for (std::uint64_t k = 0; k < count; ++k) made.push_back(expose(k));
    });
    frames = std::move(made);
    const double writing = seconds_of([&] {
      const auto writer = open();
      for (const Picture& frame : frames) writer->write(frame);
      writer->finish();
    });
    const double together = seconds_of([&] {
      std::unique_ptr<VideoWriter> writer;
      constexpr std::size_t kWaiting = 4;
      PictureQueue queue([&](Channel<PictureJob>& jobs) {
        writer = open();
        while (const auto job = jobs.pop()) writer->write(job->picture);
      }, kWaiting);
      for (std::uint64_t k = 0; k < count; ++k) queue.push({.picture = expose(k)});
      queue.finish();
      writer->finish();
    });
    if (run < 0) continue;
    exposing.push_back(alone);
    encoding.push_back(writing);
    both.push_back(together);
  }
  std::printf(
      "%llu frames of %u x %u: exposing %.3f s, encoding %.3f s, both %.3f s: %.2f of the slower alone\n",
      static_cast<unsigned long long>(count), shape.width, shape.height, median(exposing), median(encoding),
      median(both), std::max(median(exposing), median(encoding)) / median(both));
  return 0;
}

}  // namespace
}  // namespace nutik

int main(int argc, char** argv) {
  nutik::prepare_for_pocl();  // as the program does
  if (argc < 3 || argc > 4) {
    std::fprintf(stderr, "usage: bench_video CAPTURE.tik VIDEO [RUNS]\n");
    return 2;
  }
  try {
    return nutik::run(argv[1], argv[2], argc == 4 ? std::atoi(argv[3]) : 3);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_video: %s\n", error.what());
    return 1;
  }
}
