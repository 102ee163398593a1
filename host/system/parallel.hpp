// Work shared among the processor's cores.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "system/interruption.hpp"

namespace nutik {

// The processor's, at the first call: the system is asked by opening a file, which takes longer than a short loop.
inline std::uint32_t core_count() {
  static const std::uint32_t cores = std::max(std::thread::hardware_concurrency(), 1U);
  return cores;
}

// Calls work(i, tools) for every i in [0, count), each once, on as many threads as there are cores, or `max_threads` if
// that is fewer; each thread makes tools of its own first. The first exception is thrown again when all have stopped; a
// signal is one (system/interruption.hpp).
template <typename MakeTools, typename Work>
void parallel_for_with(std::uint64_t count, MakeTools make_tools, Work work,
                       std::uint32_t max_threads = ~std::uint32_t{0}) {
  std::atomic<std::uint64_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto run = [&] {
    try {
      auto tools = make_tools();
      for (std::uint64_t i = next++; i < count; i = next++) {
        check_interruption();
        work(i, tools);
      }
    } catch (...) {
      next = count;
      const std::scoped_lock lock(failure_mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  {
    const std::uint64_t workers = std::min<std::uint64_t>(count, std::min(max_threads, core_count()));
    std::vector<std::jthread> helpers;
    try {
      for (std::uint64_t i = 1; i < workers; ++i) helpers.emplace_back(run);
    } catch (const std::system_error&) {
      // The system has no more threads: those there are do the work.
    }
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

// The same without tools: calls work(i).
template <typename Work>
void parallel_for(std::uint64_t count, Work work, std::uint32_t max_threads = ~std::uint32_t{0}) {
  parallel_for_with(
      count, [] { return 0; }, [&](std::uint64_t i, int) { work(i); }, max_threads);
}

// The same for [0, count) in parts of `size`, the last of which may have fewer: calls work(first, last). A part should
// take longer than a thread does to begin, some 50 us.
template <typename Work>
void parallel_for_parts(std::uint64_t count, std::uint64_t size, Work work,
                        std::uint32_t max_threads = ~std::uint32_t{0}) {
  parallel_for(
      (count + size - 1) / size,
      [&](std::uint64_t part) { work(part * size, std::min(count, (part + 1) * size)); }, max_threads);
}

// Threads for work beside which others decode or pack.
inline std::uint32_t half_the_cores() { return std::max(core_count() / 2, 1U); }

}  // namespace nutik
