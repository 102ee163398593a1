// Preloaded before the program: lets one call of the system fail, so that it can be seen what becomes of the output.
//
//   NUTIK_FAIL_CALL     open, read, write, fsync, rename, mmap or malloc
//   NUTIK_FAIL_AT       which of them, from 1 on; 0: none
//   NUTIK_FAIL_ERROR    its errno
//   NUTIK_FAIL_AFTER    "on": all that follow fail as well, as on a full disk
//   NUTIK_FAIL_FOLDER   calls count whose file lies in it; of malloc those of a mebibyte and more
//   NUTIK_FAIL_REPORT   a file that the number of calls so far is written to
//
// Calls that the C library makes of its own are not seen.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

constexpr std::size_t kLargeAllocation = 1 << 20;

// Environment variables are read before anything is allocated: malloc() below asks for them.
struct Settings {
  const char* call = std::getenv("NUTIK_FAIL_CALL");
  const char* folder = std::getenv("NUTIK_FAIL_FOLDER");
  const char* report = std::getenv("NUTIK_FAIL_REPORT");
  const char* at = std::getenv("NUTIK_FAIL_AT");
  const char* error = std::getenv("NUTIK_FAIL_ERROR");
  const char* after = std::getenv("NUTIK_FAIL_AFTER");
};

const Settings& settings() {
  static const Settings read;
  return read;
}

std::atomic<long> calls{0};

// The program may end without its destructors: so the number is written at every call, past the functions below.
void report(long number) {
  if (settings().report == nullptr) return;
  const auto file =
      static_cast<int>(syscall(SYS_openat, AT_FDCWD, settings().report, O_CREAT | O_WRONLY, 0666));
  char text[24];
  const int length = std::snprintf(text, sizeof text, "%20ld\n", number);
  syscall(SYS_pwrite64, file, text, length, 0);
  syscall(SYS_close, file);
}

// Counts a call, and says whether it is to fail; errno is set then.
bool fails(const char* call) {
  const Settings& wanted = settings();
  if (wanted.call == nullptr || std::strcmp(call, wanted.call) != 0) return false;
  const long number = ++calls;
  report(number);
  const long at = wanted.at == nullptr ? 0 : std::atol(wanted.at);
  const bool goes_on = wanted.after != nullptr && std::strcmp(wanted.after, "on") == 0;
  if (at == 0 || number < at || (number > at && !goes_on)) return false;
  errno = wanted.error == nullptr ? EIO : std::atoi(wanted.error);
  return true;
}

bool lies_in_folder(const char* path) {
  const char* folder = settings().folder;
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
constinit Next<ssize_t(int, const iovec*, int)> next_writev{"writev"};
constinit Next<ssize_t(int, const void*, std::size_t, off64_t)> next_pwrite64{"pwrite64"};
constinit Next<int(int)> next_fsync{"fsync"};
constinit Next<int(const char*, const char*)> next_rename{"rename"};
constinit Next<void*(void*, std::size_t, int, int, int, off64_t)> next_mmap64{"mmap64"};

// Later, a search would wait for the loader, and the loader for whoever calls from a library that it is loading.
[[gnu::constructor]] void find_all() {
  const auto find = [](auto&... each) { (each.get(), ...); };
  find(next_open, next_open64, next_fopen, next_fopen64, next_read, next_pread64, next_write, next_writev,
       next_pwrite64, next_fsync, next_rename, next_mmap64);
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

ssize_t writev(int descriptor, const iovec* parts, int count) {
  return lies_in_folder(descriptor) && fails("write") ? -1 : next_writev.get()(descriptor, parts, count);
}

ssize_t pwrite64(int descriptor, const void* from, std::size_t bytes, off64_t offset) {
  return lies_in_folder(descriptor) && fails("write") ? -1
                                                      : next_pwrite64.get()(descriptor, from, bytes, offset);
}

int fsync(int descriptor) {
  return lies_in_folder(descriptor) && fails("fsync") ? -1 : next_fsync.get()(descriptor);
}

int rename(const char* from, const char* to) { return fails("rename") ? -1 : next_rename.get()(from, to); }

void* mmap64(void* address, std::size_t bytes, int protection, int flags, int descriptor, off64_t offset) {
  const bool is_counted = descriptor >= 0 ? lies_in_folder(descriptor) : bytes >= kLargeAllocation;
  return is_counted && fails("mmap")
             ? MAP_FAILED
             : next_mmap64.get()(address, bytes, protection, flags, descriptor, offset);
}

void* mmap(void* address, std::size_t bytes, int protection, int flags, int descriptor, off_t offset) {
  return mmap64(address, bytes, protection, flags, descriptor, offset);
}

// dlsym() may allocate: the C library's own names need no search.
void* __libc_malloc(std::size_t bytes);
void* malloc(std::size_t bytes) {
  return bytes >= kLargeAllocation && fails("malloc") ? nullptr : __libc_malloc(bytes);
}

}  // extern "C"
