#include "tik/rice.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>
#include <utility>

#include "tik/row_prediction.hpp"

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define NUTIK_HAS_AVX2_KERNEL 1
#include <immintrin.h>
#else
#define NUTIK_HAS_AVX2_KERNEL 0
#endif

#define NUTIK_INLINE __attribute__((always_inline)) inline

namespace nutik::tik {
namespace {

// The three streams of a group that tik/rice.hpp packs, written and read plane by plane.
constexpr std::uint32_t kLevelBits = 4;
constexpr std::uint32_t kMaxLevels = 15;
// At most these bytes of planes and of levels does a plane of codes take: 15 low bits; 15 levels of 64 bits each, and 8
// for its lines.
constexpr std::size_t kMaxPlaneBytes = 15 * 8;
constexpr std::size_t kMaxLevelBytes = 15 * 8 + 8;

// Its memory must have room for what the planes of a group come to at most.
class RiceWriter {
 public:
  RiceWriter(std::uint8_t* shapes, std::uint8_t* hows, std::byte* planes, std::byte* levels, std::uint32_t shift,
             const CodeSteps& steps)
      : shift_(shift), steps_(steps), shapes_(shapes), hows_(hows), planes_(planes), levels_(levels) {}

  // Lowest bits that no code has.
  [[nodiscard]] std::uint32_t shift() const { return shift_; }
  [[nodiscard]] bool may_step() const { return steps_.codes > 1 && steps_.codes <= CodeSteps::kLargest && shift_ == 0; }
  [[nodiscard]] const CodeSteps& steps() const { return steps_; }

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
  CodeSteps steps_;
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
             std::span<const std::byte> levels, std::uint32_t shift, const CodeSteps& steps)
      : shift_(shift),
        steps_{std::min(steps.codes, CodeSteps::kLargest), steps.white},
        shapes_(shapes),
        hows_(hows),
        planes_(planes),
        levels_(levels.data()),
        last_(levels.size() - sizeof(std::uint64_t) - 1) {}

  [[nodiscard]] std::uint32_t shift() const { return shift_; }
  [[nodiscard]] const CodeSteps& steps() const { return steps_; }
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
  CodeSteps steps_;
  const std::uint8_t* shapes_;
  const std::uint8_t* hows_;
  const std::byte* planes_;
  const std::byte* levels_;
  std::uint64_t last_;  // byte from which a word and a byte can be read
  std::uint64_t at_ = 0;
};

// Sums of 64 folded residuals: up to here no other prediction is tried.
constexpr std::uint32_t kGoodEnough = 8;
// Lines are told where no more lanes than these lie in them: 8 bits for 16 at least.
constexpr int kFewLanes = 48;

// What pext and pdep do (Hacker's Delight, 7-4 and 7-5): lanes move by 1, 2, 4 … 32.
struct Moves {
  explicit Moves(std::uint64_t mask) {
    std::uint64_t gaps = ~mask << 1;
    for (std::size_t i = 0; i < 6; ++i) {
      std::uint64_t odd = gaps;
      for (std::uint32_t by = 1; by < 64; by *= 2) odd ^= odd << by;
      moved[i] = odd & mask;
      mask = (mask ^ moved[i]) | moved[i] >> (1u << i);
      gaps &= ~odd;
    }
  }
  std::uint64_t moved[6];
};
[[maybe_unused]] std::uint64_t gathered_bits(std::uint64_t from, std::uint64_t mask) {
  if (mask == ~std::uint64_t{0}) return from;
  const Moves moves(mask);
  from &= mask;
  for (std::size_t i = 0; i < 6; ++i) {
    const std::uint64_t some = from & moves.moved[i];
    from = (from ^ some) | some >> (1u << i);
  }
  return from;
}
[[maybe_unused]] std::uint64_t scattered_bits(std::uint64_t from, std::uint64_t mask) {
  if (mask == ~std::uint64_t{0}) return from;
  const Moves moves(mask);
  for (std::size_t i = 6; i-- > 0;) {
    const std::uint64_t some = moves.moved[i];
    from = (from & ~some) | (from << (1u << i) & some);
  }
  return from & mask;
}

namespace portable {
constexpr std::size_t kVectorBytes = 16;
#define NUTIK_AVX2 0
#include "tik/rice_kernel.inl"
#undef NUTIK_AVX2
}  // namespace portable

#if NUTIK_HAS_AVX2_KERNEL
#pragma GCC push_options
#pragma GCC target("avx2,bmi,bmi2,popcnt,lzcnt")
namespace wide {
constexpr std::size_t kVectorBytes = 32;
#define NUTIK_AVX2 1
#include "tik/rice_kernel.inl"
#undef NUTIK_AVX2
}  // namespace wide
#pragma GCC pop_options

bool has_wide_kernel() {
  static const bool kHas = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2");
  return kHas;
}
#endif

// Calls use() with the kernel for a group's kind of codes.
template <typename Use>
void with_kernel(const BlockGeometry& geometry, Instructions instructions, Use use) {
  const bool colour = geometry.channels == 3, narrow = geometry.code_bytes == 1;
#if NUTIK_HAS_AVX2_KERNEL
  if (instructions == Instructions::best && has_wide_kernel()) {
    if (narrow) return colour ? use(wide::Kernel<std::uint8_t, 3>()) : use(wide::Kernel<std::uint8_t, 1>());
    return colour ? use(wide::Kernel<std::uint16_t, 3>()) : use(wide::Kernel<std::uint16_t, 1>());
  }
#endif
  static_cast<void>(instructions);
  if (narrow) return colour ? use(portable::Kernel<std::uint8_t, 3>()) : use(portable::Kernel<std::uint8_t, 1>());
  return colour ? use(portable::Kernel<std::uint16_t, 3>()) : use(portable::Kernel<std::uint16_t, 1>());
}

bool has_row_index(const TileEntry& entry, const BlockGeometry& geometry) {
  return !entry.is_records() && geometry.row_index_bytes(entry.rows()) != 0;
}

// Bytes of the sample numbers of rows.
std::uint64_t index_bytes(const TileGroup& group) {
  std::uint64_t rows = 0;
  for (const TileEntry& entry : group.entries) {
    if (has_row_index(entry, group.geometry)) rows += entry.rows();
  }
  return rows * group.geometry.index_bytes();
}

std::uint64_t plane_count(const TileGroup& group) {
  std::uint64_t planes = 0;
  for (const TileEntry& entry : group.entries) {
    planes += std::uint64_t{row_count(entry)} * group.geometry.channels;
    if (entry.is_records()) planes += entry.slots();
  }
  return planes;
}

// The sample numbers of rows, each as the difference from the one before.
template <typename Index>
void write_indices(const TileGroup& group, std::span<const std::byte> payload, std::byte* to) {
  for (const TileEntry& entry : group.entries) {
    if (!has_row_index(entry, group.geometry)) continue;
    const std::byte* const list = payload.data() + entry.offset * kBlockAlignment;
    Index before = 0;
    for (std::uint32_t row = 0; row < entry.rows(); ++row, to += sizeof(Index)) {
      Index now;
      std::memcpy(&now, list + row * sizeof now, sizeof now);
      const auto difference = static_cast<Index>(now - before);
      std::memcpy(to, &difference, sizeof difference);
      before = now;
    }
  }
}
template <typename Index>
void read_indices(const TileGroup& group, const std::byte* from, std::span<std::byte> payload) {
  for (const TileEntry& entry : group.entries) {
    if (!has_row_index(entry, group.geometry)) continue;
    std::byte* const list = payload.data() + entry.offset * kBlockAlignment;
    Index now = 0;
    for (std::uint32_t row = 0; row < entry.rows(); ++row, from += sizeof(Index)) {
      Index difference;
      std::memcpy(&difference, from, sizeof difference);
      now = static_cast<Index>(now + difference);
      std::memcpy(list + row * sizeof now, &now, sizeof now);
    }
    const std::uint64_t bytes = entry.rows() * sizeof(Index);
    std::memset(list + bytes, 0, group.geometry.row_index_bytes(entry.rows()) - bytes);
  }
}

// How many of the lowest bits no code of the group has: cameras of 12 bits often leave 4 of 16 unused.
std::uint32_t unused_bits(const TileGroup& group, std::span<const std::byte> payload) {
  if (group.geometry.code_bytes == 1) return 0;
  std::uint16_t used = 0;
  for (const TileEntry& entry : group.entries) {
    for (std::uint32_t r = 0; r < row_count(entry); ++r) {
      const std::byte* const row =
          payload.data() + entry.offset * kBlockAlignment + row_offset(entry, group.geometry, r);
      for (std::uint32_t c = 0; c < group.geometry.channels; ++c) {
        std::array<std::uint16_t, kTilePixels> codes;
        std::memcpy(codes.data(), row + c * sizeof codes, sizeof codes);
        for (const std::uint16_t code : codes) used |= code;
      }
    }
    if ((used & 1) != 0) return 0;
  }
  return used == 0 ? 0 : static_cast<std::uint32_t>(std::countr_zero(used));
}

// How many low bits all planes have; nothing where a shape is none.
std::optional<std::uint64_t> low_bits(const TileGroup& group, std::span<const std::byte> shapes) {
  const std::uint32_t most = 8 * std::max(group.geometry.code_bytes, group.geometry.index_bytes()) - 1;
  std::uint64_t bits = 0;
  std::uint8_t largest = 0;
  for (const std::byte shape : shapes) {
    const auto low = static_cast<std::uint8_t>(static_cast<std::uint8_t>(shape) >> kLevelBits);
    bits += low;
    largest = std::max(largest, low);
  }
  if (largest > most) return std::nullopt;
  return bits;
}

}  // namespace

std::uint64_t rice_head_bytes(const TileGroup& group) { return index_bytes(group) + 1 + 2 * plane_count(group); }

RiceGroup encode_rice(const TileGroup& group, std::span<const std::byte> payload, RiceRoom& room,
                      Instructions instructions) {
  const std::uint64_t planes = plane_count(group);
  RiceGroup coded;
  coded.head.resize(rice_head_bytes(group));
  if (group.geometry.index_bytes() == 1) {
    write_indices<std::uint8_t>(group, payload, coded.head.data());
  } else {
    write_indices<std::uint16_t>(group, payload, coded.head.data());
  }
  std::byte* const marks = coded.head.data() + index_bytes(group);
  const std::uint32_t shift = unused_bits(group, payload);
  *marks = static_cast<std::byte>(shift);
  auto* const shapes = reinterpret_cast<std::uint8_t*>(marks + 1);
  if (planes > room.plane_count) {
    // What is never written takes no memory.
    room = {planes, std::make_unique_for_overwrite<std::byte[]>(planes * kMaxPlaneBytes),
            std::make_unique_for_overwrite<std::byte[]>(planes * kMaxLevelBytes + 2 * sizeof(std::uint64_t))};
  }
  RiceWriter writer(shapes, shapes + planes, room.planes.get(), room.levels.get(), shift,
                    group.geometry.steps);
  with_kernel(group.geometry, instructions, [&](auto kernel) { kernel.encode(group, payload, writer); });
  writer.finish_levels();
  coded.planes = {room.planes.get(), writer.planes_end()};
  coded.levels = {room.levels.get(), writer.levels_end()};
  return coded;
}

bool decode_rice(const TileGroup& group, std::span<const std::byte> head, std::span<const std::byte> body,
                 std::span<std::byte> payload, Instructions instructions) {
  const std::uint64_t planes = plane_count(group);
  const auto marks = head.subspan(index_bytes(group));
  const auto shift = static_cast<std::uint32_t>(marks[0]);
  if (shift >= 8 * group.geometry.code_bytes) return false;
  const auto shapes = marks.subspan(1, planes), hows = marks.subspan(1 + planes);
  const auto bits = low_bits(group, shapes);
  // Levels end with a word of zeros, and have none where nothing has any.
  if (!bits || body.size() % sizeof(std::uint64_t) != 0 || body.size() / sizeof(std::uint64_t) <= *bits) return false;
  const auto levels = body.subspan(*bits * sizeof(std::uint64_t));
  // A reader asks for a byte more than the word that ends levels without any.
  std::array<std::byte, 2 * sizeof(std::uint64_t)> none{};
  const bool has_levels = levels.size() > sizeof(std::uint64_t);
  RiceReader reader(reinterpret_cast<const std::uint8_t*>(shapes.data()),
                    reinterpret_cast<const std::uint8_t*>(hows.data()), body.data(),
                    has_levels ? levels : std::span<const std::byte>(none), shift, group.geometry.steps);
  with_kernel(group.geometry, instructions, [&](auto kernel) { kernel.decode(group, reader, payload); });
  if (group.geometry.index_bytes() == 1) {
    read_indices<std::uint8_t>(group, head.data(), payload);
  } else {
    read_indices<std::uint16_t>(group, head.data(), payload);
  }
  return (reader.bits_read() + 63) / 64 + 1 == levels.size() / sizeof(std::uint64_t);
}

}  // namespace nutik::tik
