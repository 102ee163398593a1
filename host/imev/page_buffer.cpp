#include "imev/page_buffer.hpp"

#include <sys/mman.h>

#include <new>
#include <utility>

namespace nutik {
namespace {

constexpr std::uint64_t kHugePageBytes = 2 << 20;

}  // namespace

PageBuffer::PageBuffer(std::uint64_t bytes) {
  if (bytes == 0) return;
  bytes_ = (bytes + kHugePageBytes - 1) / kHugePageBytes * kHugePageBytes;
  void* mapped = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE,
                      MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (mapped == MAP_FAILED) throw std::bad_alloc();
  data_ = static_cast<std::byte*>(mapped);
  madvise(data_, bytes_, MADV_HUGEPAGE);  // a hint: without it pages are small, nothing else
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

void PageBuffer::reserve(std::uint64_t bytes) {
  if (bytes > bytes_) *this = PageBuffer(bytes);
}

}  // namespace nutik
