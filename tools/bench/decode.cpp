// Decodes a clip and does nothing with it: what encoding cannot be faster than.
//
//   bench_decode CLIP      prints the seconds, whole process start excluded, and the samples
#include <chrono>
#include <cstdio>

#include "media/clip.hpp"
#include "system/page_buffer.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: bench_decode CLIP\n");
    return 2;
  }
  try {
    const auto start = std::chrono::steady_clock::now();
    const auto clip = nutik::open_clip(argv[1], {});
    const std::uint64_t bytes = clip->info().format.sample_bytes();
    nutik::PageBuffer raster(bytes);
    unsigned long samples = 0;
    while (clip->read(raster.first(bytes))) ++samples;
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    std::printf("%.4f %lu\n", seconds.count(), samples);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_decode: %s\n", error.what());
    return 1;
  }
}
