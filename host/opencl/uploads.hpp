// Copies to a device with memory of its own.
//
//   in:      bytes wherever they lie
//   out:     the same on the device
//   how:     by way of pieces of memory that the driver has pinned, filled by several threads: a card reads those by
//            itself, seven times as fast as a driver copies other memory (docs/explanation/performance.md, "Cards")
//   always:  two pieces a thread, one being filled while the other is read
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "opencl/opencl_api.hpp"

namespace nutik {

class Uploads {
 public:
  static constexpr std::uint64_t kPieceBytes = 2 << 20;
  static constexpr std::uint32_t kMaxThreads = 8;

  Uploads(cl::Context context, const cl::Device& device);
  ~Uploads();
  Uploads(const Uploads&) = delete;
  Uploads& operator=(const Uploads&) = delete;

  // What lies in `from` is at `offset` of `to` when it returns. One thread at a time.
  void write(const cl::Buffer& to, std::uint64_t offset, std::span<const std::byte> from);

 private:
  struct Piece {
    cl::Buffer buffer;  // of the host's memory
    std::byte* memory = nullptr;
    cl::Event is_read;  // that it may be filled again; null: it was never read
  };
  void fill_and_send(Piece& piece, const cl::Buffer& to, std::uint64_t offset, std::span<const std::byte> from);

  cl::Context context_;
  cl::CommandQueue queue_;  // its own, so that copying goes on while kernels run
  std::array<Piece, std::size_t{2} * kMaxThreads> pieces_;
};

}  // namespace nutik
