#include "memory_bandwidth.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>
#include <vector>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define NUTIK_SIMD_CLONES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define NUTIK_SIMD_CLONES
#endif

namespace nutik::bench {
namespace {

constexpr int kRuns = 5;
constexpr std::size_t kStreams = 4;  // that a core reads side by side: one alone does not fill its lanes

NUTIK_SIMD_CLONES std::uint64_t sum_words(const std::uint64_t* words, std::size_t count) {
  std::uint64_t sums[kStreams * 8] = {};
  for (std::size_t i = 0; i + kStreams * 8 <= count; i += kStreams * 8) {
    for (std::size_t s = 0; s < kStreams * 8; ++s) sums[s] += words[i + s];
  }
  std::uint64_t sum = 0;
  for (const std::uint64_t part : sums) sum += part;
  return sum;
}

}  // namespace

double read_bandwidth(std::span<const std::byte> memory) {
  const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
  const auto* words = reinterpret_cast<const std::uint64_t*>(memory.data());
  const std::size_t share = memory.size() / 8 / cores;
  double best = 0.0;
  std::atomic<std::uint64_t> kept{0};  // so that nothing is optimized away
  for (int run = 0; run < kRuns; ++run) {
    const auto start = std::chrono::steady_clock::now();
    {
      std::vector<std::jthread> threads;
      for (std::size_t core = 0; core < cores; ++core) {
        threads.emplace_back([&, core] { kept += sum_words(words + core * share, share); });
      }
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    best = std::max(best, static_cast<double>(share * 8 * cores) / seconds);
  }
  return best;
}

}  // namespace nutik::bench
