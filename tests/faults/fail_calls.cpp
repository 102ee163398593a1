// Preloaded before the program: lets one call of the system fail, so that it can be seen what becomes of the output
// (faults/fault.hpp: kinds are open, read, write, fsync, rename, mmap, malloc and thread; mremap is a mapping, linkat a
// renaming, and calloc, realloc and aligned memory are malloc's).
//
//   NUTIK_FAIL_FOLDER   calls count whose file lies in it; of memory those of a mebibyte and more
//   NUTIK_CUT_FILE      a file that somebody else makes shorter at the same time ...
//   NUTIK_CUT_AT        ... as the first call of this kind, fsync or rename, has been made
//   NUTIK_NO_LOCKS      locks of files are given to everybody, as on file systems that keep them on each machine
//
// Calls that the C library makes of its own are not seen.
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <iterator>

#include "faults/fault.hpp"

namespace {

constexpr std::size_t kLargeAllocation = 1 << 20;

// Counts a call, and says whether it is to fail; errno is set then.
bool fails(const char* call) {
  const int error = nutik::test::fault_of(call, EIO);
  if (error != 0) errno = error;
  return error != 0;
}

bool lies_in_folder(const char* path) {
  static const char* const folder = std::getenv("NUTIK_FAIL_FOLDER");
  return folder != nullptr && path != nullptr && std::strncmp(path, folder, std::strlen(folder)) == 0;
}

bool lies_in_folder(int descriptor) {
  char link[64];
  char path[4096];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  if (length < 0) return false;
  path[length] = 0;
  return lies_in_folder(path);
}

// As another process would do it, after the program's first call of this kind.
void cut_at(const char* call) {
  static const char* const file = std::getenv("NUTIK_CUT_FILE");
  static const char* const at = std::getenv("NUTIK_CUT_AT");
  static constinit std::atomic<bool> is_cut{false};
  if (file == nullptr || at == nullptr || std::strcmp(at, call) != 0 || is_cut.exchange(true)) return;
  constexpr long kLeft = 1000;
  syscall(SYS_truncate, file, kLeft);
}

// The function that a call is passed on to.
template <typename Function>
struct Next {
  const char* name;
  std::atomic<Function*> function = nullptr;

  Function* get() {
    if (function == nullptr) function = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
    return function;
  }
};

constinit Next<int(const char*, int, ...)> next_open{"open"};
constinit Next<int(const char*, int, ...)> next_open64{"open64"};
constinit Next<std::FILE*(const char*, const char*)> next_fopen{"fopen"};
constinit Next<std::FILE*(const char*, const char*)> next_fopen64{"fopen64"};
constinit Next<ssize_t(int, void*, std::size_t)> next_read{"read"};
constinit Next<ssize_t(int, void*, std::size_t, off64_t)> next_pread64{"pread64"};
constinit Next<ssize_t(int, const void*, std::size_t)> next_write{"write"};
constinit Next<ssize_t(int, const void*, std::size_t, off64_t)> next_pwrite64{"pwrite64"};
constinit Next<ssize_t(int, void*, std::size_t, off64_t)> next_pread{"pread"};
constinit Next<ssize_t(int, const void*, std::size_t, off64_t)> next_pwrite{"pwrite"};
constinit Next<int(int)> next_fsync{"fsync"};
constinit Next<int(int, int)> next_flock{"flock"};
constinit Next<int(const char*, const char*)> next_rename{"rename"};
constinit Next<int(int, const char*, int, const char*, int)> next_linkat{"linkat"};
constinit Next<void*(void*, std::size_t, int, int, int, off64_t)> next_mmap64{"mmap64"};
constinit Next<void*(void*, std::size_t, std::size_t, int, ...)> next_mremap{"mremap"};
constinit Next<int(void**, std::size_t, std::size_t)> next_posix_memalign{"posix_memalign"};
constinit Next<int(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*)> next_pthread_create{"pthread_create"};

// Later, a search would wait for the loader, and the loader for whoever calls from a library that it is loading.
[[gnu::constructor]] void find_all() {
  const auto find = [](auto&... each) { (each.get(), ...); };
  find(next_open, next_open64, next_fopen, next_fopen64, next_read, next_pread64, next_write, next_pwrite64,
       next_pread, next_pwrite, next_fsync, next_flock, next_rename, next_linkat, next_mmap64, next_mremap,
       next_posix_memalign, next_pthread_create);
}

// PoCL ends the process where there is no room for what it has begun to run, and where LLVM finds none for a program
// PoCL keeps a lock of its own, for which the release of any program waits forever; of its buffers, see
// fail_device.cpp.
bool is_for_pocl() {
  void* callers[256];  // LLVM recurses
  const int count = backtrace(callers, std::size(callers));
  return std::any_of(callers, callers + count, [](const void* caller) {
    Dl_info found{};
    return dladdr(caller, &found) != 0 && found.dli_fname != nullptr &&
           std::strstr(found.dli_fname, "libpocl") != nullptr;
  });
}

bool allocation_fails(std::size_t bytes) {
  return bytes >= kLargeAllocation && !is_for_pocl() && fails("malloc");
}

bool open_fails(const char* path) {
  if (path == nullptr) return false;
  // A relative path is meant from the folder that the program was started in.
  return (path[0] != '/' || lies_in_folder(path)) && fails("open");
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = va_arg(arguments, mode_t);
  va_end(arguments);
  return open_fails(path) ? -1 : next_open.get()(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = va_arg(arguments, mode_t);
  va_end(arguments);
  return open_fails(path) ? -1 : next_open64.get()(path, flags, mode);
}

std::FILE* fopen(const char* path, const char* mode) {
  return open_fails(path) ? nullptr : next_fopen.get()(path, mode);
}

std::FILE* fopen64(const char* path, const char* mode) {
  return open_fails(path) ? nullptr : next_fopen64.get()(path, mode);
}

ssize_t read(int descriptor, void* into, std::size_t bytes) {
  return lies_in_folder(descriptor) && fails("read") ? -1 : next_read.get()(descriptor, into, bytes);
}

ssize_t pread64(int descriptor, void* into, std::size_t bytes, off64_t offset) {
  return lies_in_folder(descriptor) && fails("read") ? -1
                                                     : next_pread64.get()(descriptor, into, bytes, offset);
}

ssize_t write(int descriptor, const void* from, std::size_t bytes) {
  return lies_in_folder(descriptor) && fails("write") ? -1 : next_write.get()(descriptor, from, bytes);
}

ssize_t pwrite64(int descriptor, const void* from, std::size_t bytes, off64_t offset) {
  return lies_in_folder(descriptor) && fails("write") ? -1
                                                      : next_pwrite64.get()(descriptor, from, bytes, offset);
}

ssize_t pread(int descriptor, void* into, std::size_t bytes, off_t offset) {
  return lies_in_folder(descriptor) && fails("read") ? -1 : next_pread.get()(descriptor, into, bytes, offset);
}

ssize_t pwrite(int descriptor, const void* from, std::size_t bytes, off_t offset) {
  return lies_in_folder(descriptor) && fails("write") ? -1
                                                      : next_pwrite.get()(descriptor, from, bytes, offset);
}

int fsync(int descriptor) {
  const int result = lies_in_folder(descriptor) && fails("fsync") ? -1 : next_fsync.get()(descriptor);
  cut_at("fsync");
  return result;
}

int flock(int descriptor, int operation) noexcept {
  static const bool are_everybodys = std::getenv("NUTIK_NO_LOCKS") != nullptr;
  return are_everybodys ? 0 : next_flock.get()(descriptor, operation);
}

int rename(const char* from, const char* to) noexcept {
  const int result = fails("rename") ? -1 : next_rename.get()(from, to);
  cut_at("rename");
  return result;
}

int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) noexcept {
  const int result = fails("rename") ? -1 : next_linkat.get()(from_folder, from, to_folder, to, flags);
  cut_at("rename");
  return result;
}

void* mmap64(void* address, std::size_t bytes, int protection, int flags, int descriptor, off64_t offset) {
  const bool is_counted = descriptor >= 0 ? lies_in_folder(descriptor) : bytes >= kLargeAllocation;
  return is_counted && fails("mmap")
             ? MAP_FAILED
             : next_mmap64.get()(address, bytes, protection, flags, descriptor, offset);
}

void* mmap(void* address, std::size_t bytes, int protection, int flags, int descriptor, off_t offset) {
  return mmap64(address, bytes, protection, flags, descriptor, offset);
}

void* mremap(void* address, std::size_t before, std::size_t bytes, int flags, ...) noexcept {
  va_list arguments;
  va_start(arguments, flags);
  void* const place = (flags & MREMAP_FIXED) != 0 ? va_arg(arguments, void*) : nullptr;
  va_end(arguments);
  return bytes >= kLargeAllocation && fails("mmap") ? MAP_FAILED
                                                    : next_mremap.get()(address, before, bytes, flags, place);
}

// dlsym() may allocate: the C library's own names need no search.
void* __libc_malloc(std::size_t bytes);
void* malloc(std::size_t bytes) noexcept {
  return allocation_fails(bytes) ? nullptr : __libc_malloc(bytes);
}

void* __libc_calloc(std::size_t count, std::size_t bytes);
void* calloc(std::size_t count, std::size_t bytes) noexcept {
  std::size_t all = 0;
  if (__builtin_mul_overflow(count, bytes, &all)) all = SIZE_MAX;
  return allocation_fails(all) ? nullptr : __libc_calloc(count, bytes);
}

void* __libc_realloc(void* before, std::size_t bytes);
void* realloc(void* before, std::size_t bytes) noexcept {
  return allocation_fails(bytes) ? nullptr : __libc_realloc(before, bytes);
}

void* __libc_memalign(std::size_t alignment, std::size_t bytes);
void* aligned_alloc(std::size_t alignment, std::size_t bytes) noexcept {
  return allocation_fails(bytes) ? nullptr : __libc_memalign(alignment, bytes);
}

int posix_memalign(void** made, std::size_t alignment, std::size_t bytes) noexcept {
  if (allocation_fails(bytes)) return errno;
  return next_posix_memalign.get()(made, alignment, bytes);
}

// Threads of drivers are not ours: PoCL aborts where there are none.
int pthread_create(pthread_t* thread, const pthread_attr_t* how, void* (*work)(void*), void* with) noexcept {
  if (!is_for_pocl() && fails("thread")) return errno;
  return next_pthread_create.get()(thread, how, work, with);
}

}  // extern "C"
