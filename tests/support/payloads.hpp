// Blocks' payloads as files hold them, copied out of their source.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "imev/capture_source.hpp"

namespace nutik::test {

[[nodiscard]] inline std::vector<std::byte> payload_of(const CaptureFormat& capture,
                                                       const BlockLease& lease) {
  std::vector<std::byte> payload(lease.bytes());
  lease.copy_to(capture, payload);
  return payload;
}

[[nodiscard]] inline std::vector<std::byte> payload_of(CaptureSource& source, std::uint64_t block) {
  return payload_of(source.format(), source.acquire(block));
}

}  // namespace nutik::test
