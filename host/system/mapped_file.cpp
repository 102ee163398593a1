#include "system/mapped_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <mutex>
#include <new>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "system/interruption.hpp"
#include "system/is_absent.hpp"
#include "system/reused_entries.hpp"
#include "system/shared_state.hpp"

namespace nutik {

struct WatchedMapping {
  // What a signal handler looks at; 0 where nothing is mapped.
  std::atomic<std::uintptr_t> begin{0};
  std::atomic<std::size_t> bytes{0};
  std::atomic<bool> is_lost{false};
  WatchedMapping* next = nullptr;
  // The rest is guarded by `registering_mappings`.
  bool is_free = false;
  bool is_counted = false;
  std::string name;
  int descriptor = -1;
  struct stat at_first {};
};

namespace {

std::size_t page_bytes() {
  static const auto bytes = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  return bytes;
}

std::size_t whole_file_pages(std::size_t bytes) {
  return (bytes + page_bytes() - 1) / page_bytes() * page_bytes();
}

// Puts zeros where the file's bytes were, from the page on that could not be read, so that whoever reads them can go
// on until it is asked whether anything was lost.
void replace_lost_pages(int number, siginfo_t* info, void* context) {
  const int error = errno;
  const auto at = reinterpret_cast<std::uintptr_t>(info->si_addr);
  for (WatchedMapping* mapping = shared_state().mappings.load(); mapping != nullptr;
       mapping = mapping->next) {
    const std::uintptr_t begin = mapping->begin.load();
    const std::uintptr_t end = begin + whole_file_pages(mapping->bytes.load());
    if (info->si_code <= 0 || at < begin || at >= end) continue;  // sent by a process: of no address
    const std::uintptr_t page = at / page_bytes() * page_bytes();
    if (mmap(reinterpret_cast<void*>(page), end - page, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED,
             -1, 0) == MAP_FAILED) {
      break;
    }
    mapping->is_lost.store(true);
    errno = error;
    return;
  }
  const struct sigaction& action_before = shared_state().bus_action_before;
  // Not of ours: it is for whoever was asked before, or has its usual end.
  if ((action_before.sa_flags & SA_SIGINFO) != 0) {
    action_before.sa_sigaction(number, info, context);
  } else if (action_before.sa_handler != SIG_DFL && action_before.sa_handler != SIG_IGN) {
    action_before.sa_handler(number);
  } else {
    std::signal(number, SIG_DFL);
    raise(number);
  }
  errno = error;
}

bool is_unchanged(const WatchedMapping& mapping) {
  if (mapping.is_lost.load()) return false;
  struct stat now {};
  const struct stat& before = mapping.at_first;
  return fstat(mapping.descriptor, &now) == 0 && now.st_size == before.st_size &&
         now.st_mtim.tv_sec == before.st_mtim.tv_sec && now.st_mtim.tv_nsec == before.st_mtim.tv_nsec;
}

WatchedMapping* watch(std::string name, int descriptor, const struct stat& status, const void* begin) {
  const std::scoped_lock lock(shared_state().registering_mappings);
  WatchedMapping* const mapping = &reused_entry(shared_state().mappings);
  mapping->is_lost.store(false);
  mapping->is_counted = false;
  mapping->name = std::move(name);
  mapping->descriptor = descriptor;
  mapping->at_first = status;
  mapping->begin.store(reinterpret_cast<std::uintptr_t>(begin));
  mapping->bytes.store(static_cast<std::size_t>(status.st_size));
  return mapping;
}

// Under the lock.
void count_loss(WatchedMapping& mapping) {
  if (mapping.is_counted || is_unchanged(mapping)) return;
  mapping.is_counted = true;
  shared_state().mapped_losses += 1;
  shared_state().last_lost_file = mapping.name;
}

void count_losses() {
  for (WatchedMapping* mapping = shared_state().mappings.load(); mapping != nullptr;
       mapping = mapping->next) {
    if (mapping->descriptor >= 0) count_loss(*mapping);
  }
}

void forget(WatchedMapping* mapping) {
  const std::scoped_lock lock(shared_state().registering_mappings);
  count_loss(*mapping);
  close(mapping->descriptor);
  mapping->descriptor = -1;
  mapping->bytes.store(0);
  mapping->begin.store(0);
  mapping->is_free = true;
}

[[noreturn]] void throw_lost(const std::string& name) {
  throw InputError(
      format("{} changed or could not be read any more while it was read; what was being made of it is not "
             "kept. Leave the file alone, or make a copy first",
             name));
}

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& path) {
  const auto fail = [&](const char* reason) {
    throw InputError(format("{} cannot be read: {}", path.string(), reason));
  };
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0 && (errno == ENOENT || errno == ENOTDIR))
    throw FileMissing(path, format("{} cannot be read: {}", path.string(), std::strerror(errno)));
  if (descriptor < 0) fail(std::strerror(errno));
  struct stat status {};
  const bool known = fstat(descriptor, &status) == 0;
  if (!known || !S_ISREG(status.st_mode)) {
    close(descriptor);
    fail(known && S_ISDIR(status.st_mode) ? "it is a folder" : "it is no regular file");
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size == 0) {
    close(descriptor);
    return;
  }
  void* mapped = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
  const int reason = errno;
  if (mapped == MAP_FAILED) {
    close(descriptor);
    if (reason == ENOMEM) throw std::bad_alloc();
    fail(std::strerror(reason));
  }
  bytes_ = {static_cast<const std::byte*>(mapped), size};
  watched_ = watch(path.string(), descriptor, status, mapped);
}

MappedFile::~MappedFile() {
  if (watched_ == nullptr) return;
  const std::span<const std::byte> bytes = bytes_;
  forget(watched_);
  munmap(const_cast<std::byte*>(bytes.data()), bytes.size());
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : bytes_(std::exchange(other.bytes_, {})), watched_(std::exchange(other.watched_, nullptr)) {}

void MappedFile::check() const {
  if (watched_ != nullptr && !is_unchanged(*watched_)) throw_lost(watched_->name);
}

void MappedFile::release(std::span<const std::byte> part) const {
  // Whole pages only: those at the ends hold others' bytes too.
  const std::size_t page = page_bytes();
  const auto offset = static_cast<std::size_t>(part.data() - bytes_.data());
  const std::size_t begin = (offset + page - 1) / page * page;
  const std::size_t end = (offset + part.size()) / page * page;
  if (begin < end) madvise(const_cast<std::byte*>(bytes_.data()) + begin, end - begin, MADV_DONTNEED);
}

void watch_mapped_files() {
  static_cast<void>(page_bytes());  // a handler may not be the first to ask
  SharedState& state = shared_state();
  if (!state.is_watching.exchange(true)) sigaction(SIGBUS, nullptr, &state.bus_action_before);
  take_back_signals();
}

void take_back_signals() {
  if (shared_state().heeds_limits) catch_limits();
  if (!shared_state().is_watching) return;
  struct sigaction now {};
  if (sigaction(SIGBUS, nullptr, &now) == 0 && now.sa_sigaction == replace_lost_pages) return;
  struct sigaction action {};
  action.sa_sigaction = replace_lost_pages;
  action.sa_flags = SA_SIGINFO | SA_ONSTACK;  // as whoever was asked before may need it
  sigemptyset(&action.sa_mask);
  sigaction(SIGBUS, &action, nullptr);
}

void do_one_work() { shared_state().is_one_work = true; }

MappedLosses losses_so_far() {
  if (shared_state().is_one_work) return {};
  const std::scoped_lock lock(shared_state().registering_mappings);
  count_losses();
  return {shared_state().mapped_losses};
}

void check_mapped_files(MappedLosses before) {
  const std::scoped_lock lock(shared_state().registering_mappings);
  count_losses();
  if (shared_state().mapped_losses > before.count) throw_lost(shared_state().last_lost_file);
}

std::string first_bytes(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return {};
  std::ifstream in(path, std::ios::binary);
  std::array<char, 16> bytes{};
  in.read(bytes.data(), bytes.size());
  return {bytes.data(), static_cast<std::size_t>(in.gcount())};
}

}  // namespace nutik
