#include "system/checksum.hpp"

#include <xxhash.h>

#include <new>

namespace nutik {

std::uint64_t checksum(std::span<const std::byte> bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

std::uint64_t checksum(std::string_view text) { return XXH3_64bits(text.data(), text.size()); }

Checksum::Checksum() : state_(XXH3_createState()) {
  if (!state_) throw std::bad_alloc();
  XXH3_64bits_reset(state_.get());
}

void Checksum::Free::operator()(XXH3_state_s* state) const { XXH3_freeState(state); }

void Checksum::add(std::span<const std::byte> part) {
  XXH3_64bits_update(state_.get(), part.data(), part.size());
}

std::uint64_t Checksum::value() const { return XXH3_64bits_digest(state_.get()); }

}  // namespace nutik
