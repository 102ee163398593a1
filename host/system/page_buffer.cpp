#include "system/page_buffer.hpp"

#include <sys/mman.h>

#include <cstring>
#include <new>
#include <utility>

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

// A hint: without it pages are small, nothing else.
void prefer_huge_pages(void* memory, std::uint64_t bytes) {
  if (bytes >= kHugeFromBytes) madvise(memory, bytes, MADV_HUGEPAGE);
}

}  // namespace

PageBuffer::PageBuffer(std::uint64_t bytes) {
  if (bytes == 0) return;
  bytes_ = whole_pages(bytes);
  void* mapped =
      mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (mapped == MAP_FAILED) throw std::bad_alloc();
  data_ = static_cast<std::byte*>(mapped);
  prefer_huge_pages(data_, bytes_);
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
#ifdef __SANITIZE_THREAD__  // it does not see pages move, and takes what was there before for a race
  PageBuffer larger(bytes);
  std::memcpy(larger.data_, data_, bytes_);
  *this = std::move(larger);
#else
  // Pages are moved, not copied.
  void* mapped = mremap(data_, bytes_, whole_pages(bytes), MREMAP_MAYMOVE);
  if (mapped == MAP_FAILED) throw std::bad_alloc();
  data_ = static_cast<std::byte*>(mapped);
  bytes_ = whole_pages(bytes);
  prefer_huge_pages(data_, bytes_);
#endif
}

void PageBuffer::reserve(std::uint64_t bytes) {
  if (bytes > bytes_) *this = PageBuffer(bytes);
}

}  // namespace nutik
