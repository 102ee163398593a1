#include "system/page_buffer.hpp"

#include <sys/mman.h>

#include <new>
#include <utility>

#include "system/linux_calls.hpp"

namespace nutik {
namespace {

constexpr std::uint64_t kPageBytes = 4096;
constexpr std::uint64_t kHugePageBytes = 2 << 20;
// Smaller buffers would spend longer on clearing huge pages than on their own work.
constexpr std::uint64_t kHugeFromBytes = 4 * kHugePageBytes;

// In whole pages of the size that suits so many bytes.
std::uint64_t whole_pages(std::uint64_t bytes) {
  const std::uint64_t unit = bytes >= kHugeFromBytes ? kHugePageBytes : kPageBytes;
  return (bytes + unit - 1) / unit * unit;
}

void hint_size(void* memory, std::uint64_t bytes) {
  if (bytes >= kHugeFromBytes) prefer_huge_pages(memory, bytes);
}

}  // namespace

PageBuffer::PageBuffer(std::uint64_t bytes) {
  if (bytes == 0) return;
  bytes_ = whole_pages(bytes);
  void* mapped =
      mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (mapped == MAP_FAILED) throw std::bad_alloc();
  data_ = static_cast<std::byte*>(mapped);
  hint_size(data_, bytes_);
}

PageBuffer::~PageBuffer() {
  if (data_ != nullptr) munmap(data_, bytes_);
}

PageBuffer::PageBuffer(PageBuffer&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}

PageBuffer& PageBuffer::operator=(PageBuffer&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

void PageBuffer::grow(std::uint64_t bytes) {
  if (bytes <= bytes_) return;
  if (data_ == nullptr) {
    *this = PageBuffer(bytes);
    return;
  }
  void* mapped = grow_mapping(data_, bytes_, whole_pages(bytes));
  if (mapped == MAP_FAILED) throw std::bad_alloc();
  data_ = static_cast<std::byte*>(mapped);
  bytes_ = whole_pages(bytes);
  hint_size(data_, bytes_);
}

void PageBuffer::reserve(std::uint64_t bytes) {
  if (bytes > bytes_) *this = PageBuffer(bytes);
}

}  // namespace nutik
