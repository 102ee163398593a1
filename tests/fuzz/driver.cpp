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

// Of blocks as large as these what was touched is counted, when they are released: FFmpeg reserves room for as many
// entries of a table as a file states, up to 2 GB, and takes none of it where the file ends.
constexpr std::size_t kReservedFromBytes = std::size_t{1} << 28;

std::int64_t touched_bytes(const volatile void* memory, std::size_t bytes) {
  const std::size_t page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::uintptr_t begin = reinterpret_cast<std::uintptr_t>(memory) / page * page;
  std::int64_t touched = 0;
  std::array<unsigned char, 4096> resident;
  for (std::uintptr_t at = begin; at < begin + bytes; at += resident.size() * page) {
    const std::size_t pages = std::min(resident.size(), (begin + bytes - at + page - 1) / page);
    // Where the system does not tell, all counts.
    if (mincore(reinterpret_cast<void*>(at), pages * page, resident.data()) != 0)
      return static_cast<std::int64_t>(bytes);
    for (std::size_t i = 0; i < pages; ++i) touched += resident[i] & 1 ? static_cast<std::int64_t>(page) : 0;
  }
  return touched;
}

void count_allocation(const volatile void* /*memory*/, std::size_t bytes) {
  if (bytes >= kReservedFromBytes) return;
  const std::int64_t now = allocated_bytes += static_cast<std::int64_t>(bytes);
  const std::int64_t ceiling = ceiling_bytes;
  if (now > ceiling) end_above_ceiling(now, ceiling);
}

void count_release(const volatile void* memory) {
  if (memory == nullptr) return;
  const std::size_t bytes = __sanitizer_get_allocated_size(const_cast<const void*>(memory));
  if (bytes < kReservedFromBytes) {
    allocated_bytes -= static_cast<std::int64_t>(bytes);
    return;
  }
  const std::int64_t ceiling = ceiling_bytes;
  const std::int64_t with_it = allocated_bytes + touched_bytes(memory, bytes);
  if (with_it > ceiling) end_above_ceiling(with_it, ceiling);
}

// Of the process, so that a busy machine makes no findings.
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
