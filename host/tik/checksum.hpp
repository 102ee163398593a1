// XXH3-64, the checksum of everything in a .tik (docs/tik-format.md).
#pragma once

#include <xxhash.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace nutik::tik {

[[nodiscard]] inline std::uint64_t checksum(std::span<const std::byte> bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

// Of parts that come one after the other.
class Checksum {
 public:
  Checksum();
  void add(std::span<const std::byte> part) { XXH3_64bits_update(state_.get(), part.data(), part.size()); }
  [[nodiscard]] std::uint64_t value() const { return XXH3_64bits_digest(state_.get()); }

 private:
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };
  std::unique_ptr<XXH3_state_t, Free> state_;
};

// Of a structure's bytes before its own checksum.
template <typename Struct>
[[nodiscard]] std::uint64_t checksum_of(const Struct& structure, std::size_t bytes) {
  return checksum({reinterpret_cast<const std::byte*>(&structure), bytes});
}

}  // namespace nutik::tik
