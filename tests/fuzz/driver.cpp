#include <sanitizer/allocator_interface.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <mutex>
#include <string>

#include "capture/error.hpp"
#include "fuzz/target.hpp"

namespace nutik::fuzz {
namespace {

constexpr double kMaxSeconds = 10;

// Counted by hooks of the allocator, of all threads.
constexpr std::int64_t kNoCeiling = std::numeric_limits<std::int64_t>::max();
std::atomic<std::int64_t> allocated_bytes{
    0};  // since the input was begun; less than nothing where older memory went
std::atomic<std::int64_t> ceiling_bytes{kNoCeiling};
std::atomic<std::size_t> input_bytes{0};

[[noreturn]] void end_above_ceiling(std::int64_t bytes, std::int64_t ceiling) {
  ceiling_bytes = kNoCeiling;  // printing allocates
  std::fprintf(stderr, "%lld bytes allocated for an input of %zu; its ceiling is %lld\n",
               static_cast<long long>(bytes), input_bytes.load(), static_cast<long long>(ceiling));
  std::abort();
}

// Blocks of MemoryCeiling::reserved_from bytes and more count by what was touched of them, whenever one is released.
struct Block {
  const volatile void* memory = nullptr;
  std::size_t bytes = 0;
};
std::mutex reserved_mutex;
std::array<Block, 64> reserved;  // those that are there; the rest of them counts whole

std::int64_t touched_bytes(const Block& block) {
  const std::size_t page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::uintptr_t begin = reinterpret_cast<std::uintptr_t>(block.memory) / page * page;
  const std::uintptr_t end = reinterpret_cast<std::uintptr_t>(block.memory) + block.bytes;
  std::int64_t touched = 0;
  std::array<unsigned char, 4096> resident;
  for (std::uintptr_t at = begin; at < end; at += resident.size() * page) {
    const std::size_t pages = std::min(resident.size(), (end - at + page - 1) / page);
    // Where the system does not tell, all counts.
    if (mincore(reinterpret_cast<void*>(at), pages * page, resident.data()) != 0)
      return static_cast<std::int64_t>(block.bytes);
    for (std::size_t i = 0; i < pages; ++i) touched += resident[i] & 1 ? static_cast<std::int64_t>(page) : 0;
  }
  return touched;
}

bool is_reserved(const volatile void* memory, std::size_t bytes) {
  if (bytes < kTarget.ceiling.reserved_from) return false;
  const std::lock_guard lock(reserved_mutex);
  const auto free = std::ranges::find(reserved, nullptr, &Block::memory);
  if (free == reserved.end()) return false;
  *free = {memory, bytes};
  return true;
}

// Whether it was; with what was touched of it and the others until now.
bool release_reserved(const volatile void* memory) {
  const std::lock_guard lock(reserved_mutex);
  const auto found = std::ranges::find(reserved, memory, &Block::memory);
  if (found == reserved.end()) return false;
  const std::int64_t ceiling = ceiling_bytes;
  if (ceiling != kNoCeiling) {
    std::int64_t now = allocated_bytes;
    for (const Block& block : reserved) now += block.memory == nullptr ? 0 : touched_bytes(block);
    if (now > ceiling) end_above_ceiling(now, ceiling);
  }
  *found = {};
  return true;
}

void count_allocation(const volatile void* memory, std::size_t bytes) {
  if (is_reserved(memory, bytes)) return;
  const std::int64_t now = allocated_bytes += static_cast<std::int64_t>(bytes);
  const std::int64_t ceiling = ceiling_bytes;
  if (now > ceiling) end_above_ceiling(now, ceiling);
}

void count_release(const volatile void* memory) {
  if (memory == nullptr) return;
  const std::size_t bytes = __sanitizer_get_allocated_size(const_cast<const void*>(memory));
  if (bytes >= kTarget.ceiling.reserved_from && release_reserved(memory)) return;
  allocated_bytes -= static_cast<std::int64_t>(bytes);
}

// The process's own, so that a busy machine makes no findings.
double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::filesystem::path make_folder() {
  const char* root = std::getenv("TMPDIR");
  std::string pattern = std::string(root == nullptr ? "/tmp" : root) + "/nutik-fuzz-XXXXXX";
  if (mkdtemp(pattern.data()) == nullptr) {
    std::perror(pattern.c_str());
    std::exit(1);
  }
  return pattern;
}

// Removed when the process ends well; after a finding the input is still there to be looked at.
struct Folder {
  std::filesystem::path path = make_folder();
  ~Folder() {
    std::error_code error;
    std::filesystem::remove_all(path, error);
  }
};

}  // namespace

std::filesystem::path as_file(Bytes input, std::string_view name) {
  static const Folder folder;
  std::filesystem::path path = folder.path / name;
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(input.data()), static_cast<std::streamsize>(input.size()));
  return path;
}

void demand(bool holds, std::string_view what) {
  if (holds) return;
  std::fprintf(stderr, "it does not hold: %.*s\n", static_cast<int>(what.size()), what.data());
  std::abort();
}

}  // namespace nutik::fuzz

using namespace nutik::fuzz;

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  if (kTarget.prepare != nullptr) kTarget.prepare();
  if (__sanitizer_install_malloc_and_free_hooks(count_allocation, count_release) == 0) {
    std::fprintf(stderr, "the allocator takes no hooks\n");
    std::exit(1);
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Bytes input{reinterpret_cast<const std::byte*>(data), size};
  input_bytes = size;
  allocated_bytes = 0;
  ceiling_bytes = static_cast<std::int64_t>(kTarget.ceiling.fixed + kTarget.ceiling.per_input_byte * size);
  const double begin = cpu_seconds();
  try {
    kTarget.read(input);
  } catch (const nutik::Error&) {
  }
  ceiling_bytes = kNoCeiling;
  demand(cpu_seconds() - begin <= kMaxSeconds, "an input takes ten seconds of CPU at most");
  return 0;
}
