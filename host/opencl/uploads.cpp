#include "opencl/uploads.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <utility>

#include "system/parallel.hpp"

namespace nutik {

Uploads::Uploads(cl::Context context, const cl::Device& device)
    : context_(std::move(context)), queue_(context_, device) {}

Uploads::~Uploads() {
  for (Piece& piece : pieces_) {
    if (piece.memory == nullptr) continue;
    ::clEnqueueUnmapMemObject(queue_(), piece.buffer(), piece.memory, 0, nullptr, nullptr);
    ::clFinish(queue_());
  }
}

void Uploads::write(const cl::Buffer& to, std::uint64_t offset, std::span<const std::byte> from) {
  if (from.size() < 2 * kPieceBytes) {  // what little there is gains nothing
    queue_.enqueueWriteBuffer(to, CL_TRUE, offset, from.size(), from.data());
    return;
  }
  std::atomic<std::size_t> threads{0};
  parallel_for_with(
      (from.size() + kPieceBytes - 1) / kPieceBytes,
      [&] { return std::span(pieces_).subspan(2 * threads++, 2); },
      [&](std::uint64_t i, std::span<Piece>& own) {
        const std::uint64_t at = i * kPieceBytes;
        fill_and_send(own[0], to, offset + at, from.subspan(at, std::min(kPieceBytes, from.size() - at)));
        std::swap(own[0], own[1]);
      },
      kMaxThreads);
  queue_.finish();
}

void Uploads::fill_and_send(Piece& piece, const cl::Buffer& to, std::uint64_t offset,
                            std::span<const std::byte> from) {
  if (piece.memory == nullptr) {
    piece.buffer = cl::Buffer(context_, CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR, kPieceBytes);
    piece.memory = static_cast<std::byte*>(
        queue_.enqueueMapBuffer(piece.buffer, CL_TRUE, CL_MAP_WRITE, 0, kPieceBytes));
  }
  if (piece.is_read() != nullptr) piece.is_read.wait();
  std::memcpy(piece.memory, from.data(), from.size());
  queue_.enqueueWriteBuffer(to, CL_FALSE, offset, from.size(), piece.memory, nullptr, &piece.is_read);
  queue_.flush();
}

}  // namespace nutik
