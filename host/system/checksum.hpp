// XXH3-64, by which files, captures and built kernels are known again.
//
//   in:      bytes, whole or part by part; the parts' lengths make no difference
//   threads: each Checksum belongs to one
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

struct XXH3_state_s;

namespace nutik {

[[nodiscard]] std::uint64_t checksum(std::span<const std::byte> bytes);
[[nodiscard]] std::uint64_t checksum(std::string_view text);

// The checksum of a structure's bytes before its own checksum.
template <typename Struct>
[[nodiscard]] std::uint64_t checksum_of(const Struct& structure, std::size_t bytes) {
  return checksum({reinterpret_cast<const std::byte*>(&structure), bytes});
}

// The checksum of parts that come one after the other.
class Checksum {
 public:
  Checksum();
  void add(std::span<const std::byte> part);
  [[nodiscard]] std::uint64_t value() const;

 private:
  struct Free {
    void operator()(XXH3_state_s* state) const;
  };
  std::unique_ptr<XXH3_state_s, Free> state_;
};

}  // namespace nutik
