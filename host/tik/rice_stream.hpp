// The three streams of a group that tik/rice.hpp packs, written and read plane by plane.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "tik/rice.hpp"

namespace nutik::tik {

inline constexpr std::uint32_t kLevelBits = 4;
inline constexpr std::uint32_t kMaxLevels = 15;
// At most these bytes of planes and of levels does a plane of codes take: 15 low bits; 15 levels of 64 bits each, and 8 for
// its lines.
inline constexpr std::size_t kMaxPlaneBytes = 15 * 8;
inline constexpr std::size_t kMaxLevelBytes = 15 * 8 + 8;

// Its memory must have room for what the planes of a group come to at most.
class RiceWriter {
 public:
  RiceWriter(std::uint8_t* shapes, std::uint8_t* hows, std::byte* planes, std::byte* levels, std::uint32_t shift)
      : shift_(shift), shapes_(shapes), hows_(hows), planes_(planes), levels_(levels) {}

  // Lowest bits that no code has.
  [[nodiscard]] std::uint32_t shift() const { return shift_; }

  void put_mark(std::uint8_t shape, std::uint8_t how) {
    *shapes_++ = shape;
    *hows_++ = how;
  }
  void put_plane(std::uint64_t bits) {
    std::memcpy(planes_, &bits, sizeof bits);
    planes_ += sizeof bits;
  }
  // Up to 64 bits; those above are 0.
  void put(std::uint64_t bits, std::uint32_t count) {
    waiting_ |= bits << filled_;
    if (filled_ + count < 64) {
      filled_ += count;
      return;
    }
    put_word();
    waiting_ = filled_ == 0 ? 0 : bits >> (64 - filled_);
    filled_ = filled_ + count - 64;
  }
  // What waits, filled up with zeros, and a word of zeros, so that a word and a byte can be read wherever a bit is.
  void finish_levels() {
    if (filled_ != 0) put_word();
    waiting_ = 0;
    put_word();
  }
  [[nodiscard]] std::byte* planes_end() const { return planes_; }
  [[nodiscard]] std::byte* levels_end() const { return levels_; }

 private:
  void put_word() {
    std::memcpy(levels_, &waiting_, sizeof waiting_);
    levels_ += sizeof waiting_;
  }

  std::uint32_t shift_;
  std::uint8_t* shapes_;
  std::uint8_t* hows_;
  std::byte* planes_;
  std::byte* levels_;
  std::uint64_t waiting_ = 0;
  std::uint32_t filled_ = 0;
};

// Marks and planes must be as many as will be asked for. Levels are read within their bytes, whatever is asked.
class RiceReader {
 public:
  RiceReader(const std::uint8_t* shapes, const std::uint8_t* hows, const std::byte* planes,
             std::span<const std::byte> levels, std::uint32_t shift)
      : shift_(shift),
        shapes_(shapes),
        hows_(hows),
        planes_(planes),
        levels_(levels.data()),
        last_(levels.size() - sizeof(std::uint64_t) - 1) {}

  [[nodiscard]] std::uint32_t shift() const { return shift_; }
  RiceMark get_mark() { return {*shapes_++, *hows_++}; }
  std::uint64_t get_plane() {
    std::uint64_t bits;
    std::memcpy(&bits, planes_, sizeof bits);
    planes_ += sizeof bits;
    return bits;
  }
  // Up to 64 bits.
  std::uint64_t get(std::uint32_t count) {
    const std::byte* const from = levels_ + std::min(at_ / 8, last_);
    std::uint64_t low;
    std::memcpy(&low, from, sizeof low);
    const auto high = static_cast<std::uint64_t>(from[sizeof low]);
    const std::uint64_t skipped = at_ % 8;
    at_ += count;
    const std::uint64_t bits = low >> skipped | high << 1 << (63 - skipped);
    return count == 0 ? 0 : bits & ~std::uint64_t{0} >> (64 - count);
  }
  [[nodiscard]] std::uint64_t bits_read() const { return at_; }

 private:
  std::uint32_t shift_;
  const std::uint8_t* shapes_;
  const std::uint8_t* hows_;
  const std::byte* planes_;
  const std::byte* levels_;
  std::uint64_t last_;  // byte from which a word and a byte can be read
  std::uint64_t at_ = 0;
};

}  // namespace nutik::tik
