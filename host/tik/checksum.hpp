#pragma once

#include <xxhash.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace nutik::tik {

[[nodiscard]] inline std::uint64_t checksum(std::span<const std::byte> bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

// Of parts, as if they lay one behind the other.
[[nodiscard]] std::uint64_t checksum(std::span<const std::span<const std::byte>> parts);

// Of a structure's bytes before its own checksum.
template <typename Struct>
[[nodiscard]] std::uint64_t checksum_of(const Struct& structure, std::size_t bytes) {
  return checksum({reinterpret_cast<const std::byte*>(&structure), bytes});
}

}  // namespace nutik::tik
