// A payload as files hold it.
//
//   in:      a payload in memory, whose bodies may lie apart
//   out:     its parts in the order of files: a directory for bodies that lie one behind the other, then those
//            bodies, not copied; neighbours in memory are one part
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "imev/block.hpp"

namespace nutik {

class PayloadParts {
 public:
  // `payload` must outlive this.
  PayloadParts(const BlockGeometry& geometry, std::span<const std::byte> payload);
  PayloadParts(const PayloadParts&) = delete;
  PayloadParts& operator=(const PayloadParts&) = delete;

  [[nodiscard]] std::span<const std::span<const std::byte>> parts() const { return parts_; }
  // Of all parts together.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  // Writes them one behind the other to `into`, which has at least as many bytes.
  void copy_to(std::span<std::byte> into) const;

 private:
  std::vector<std::byte> directory_;
  std::vector<std::span<const std::byte>> parts_;
  std::uint64_t bytes_;
};

}  // namespace nutik
