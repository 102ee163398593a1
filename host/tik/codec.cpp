#include "tik/codec.hpp"

#include <lz4.h>
#include <zstd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstring>
#include <limits>
#include <memory>
#include <mutex>
#include <new>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "system/parallel.hpp"
#include "tik/prediction.hpp"
#include "tik/rice.hpp"

namespace nutik::tik {
namespace {

// Large enough for the compressor to learn each part of a group, small enough to keep all cores busy.
constexpr std::uint64_t kGroupBytes = 2 << 20;
constexpr int kDefaultZstdLevel = 1;

// What packs the counts of tiles and the heads of groups.
Codec general_codec(const Codec& codec) { return codec.id == CodecId::rice ? Codec{CodecId::zstd, 0} : codec; }

// How many bytes of a payload slow codecs have packed, which is told by one thread at a time.
class PackedBytes {
 public:
  PackedBytes(const ReportedProgress& progress, std::uint64_t total) : progress_(progress), total_(total) {}

  void add(std::uint64_t bytes) {
    if (!progress_) return;
    const std::lock_guard lock(telling_);
    done_ = std::min(done_ + bytes, total_);  // a group's plain form has a few more than its payload
    progress_(done_, total_);
  }

 private:
  const ReportedProgress& progress_;
  std::mutex telling_;
  std::uint64_t done_ = 0, total_;
};

// What a thread packs with, one group after the other.
struct PackingTools {
  explicit PackingTools(PackedBytes& of) : packed(of) {}
  PackedBytes& packed;
  RiceRoom room;
  std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> zstd{ZSTD_createCCtx(), &ZSTD_freeCCtx};
};

// The bytes that it takes. A slow level is given its bytes little by little, so that it can tell and be stopped: that
// makes the same of them.
std::size_t zstd_packed(const Codec& codec, std::span<const std::byte> plain, std::span<std::byte> packed,
                        PackingTools& tools) {
  constexpr std::size_t kBytesAtOnce = 128 << 10;
  const auto checked = [](std::size_t result) {
    if (ZSTD_isError(result)) throw OutputError(format("zstd failed: {}", ZSTD_getErrorName(result)));
    return result;
  };
  ZSTD_CCtx* const zstd = tools.zstd.get();
  if (zstd == nullptr) throw std::bad_alloc();
  const int level = codec.level == 0 ? kDefaultZstdLevel : codec.level;
  if (!codec.is_slow())
    return checked(ZSTD_compressCCtx(zstd, packed.data(), packed.size(), plain.data(), plain.size(), level));
  checked(ZSTD_CCtx_reset(zstd, ZSTD_reset_session_and_parameters));
  checked(ZSTD_CCtx_setParameter(zstd, ZSTD_c_compressionLevel, level));
  checked(ZSTD_CCtx_setPledgedSrcSize(zstd, plain.size()));
  ZSTD_outBuffer to{packed.data(), packed.size(), 0};
  while (true) {
    ZSTD_inBuffer from{plain.data(), std::min(plain.size(), kBytesAtOnce), 0};
    plain = plain.subspan(from.size);
    checked(ZSTD_compressStream2(zstd, &to, &from, plain.empty() ? ZSTD_e_end : ZSTD_e_continue));
    tools.packed.add(from.size);
    if (plain.empty()) return to.pos;
  }
}

std::vector<std::byte> compress(const Codec& codec, std::span<const std::byte> plain, PackingTools& tools) {
  std::vector<std::byte> packed;
  if (codec.id == CodecId::lz4) {
    if (plain.size() > LZ4_MAX_INPUT_SIZE) {
      throw OutputError(format("lz4 packs at most {} bytes at once, not {}; use codec zstd",
                               LZ4_MAX_INPUT_SIZE, plain.size()));
    }
    packed.resize(static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(plain.size()))));
    const int bytes = LZ4_compress_default(reinterpret_cast<const char*>(plain.data()),
                                           reinterpret_cast<char*>(packed.data()),
                                           static_cast<int>(plain.size()), static_cast<int>(packed.size()));
    if (bytes <= 0) throw OutputError(format("lz4 failed to pack {} bytes", plain.size()));
    packed.resize(static_cast<std::size_t>(bytes));
  } else {
    packed.resize(ZSTD_compressBound(plain.size()));
    packed.resize(zstd_packed(codec, plain, packed, tools));
  }
  return packed;
}

bool decompress(CodecId codec, std::span<const std::byte> packed, std::span<std::byte> plain) {
  if (codec == CodecId::lz4) {
    constexpr std::size_t kLargest = std::numeric_limits<int>::max();
    if (packed.size() > kLargest || plain.size() > LZ4_MAX_INPUT_SIZE) return false;
    return LZ4_decompress_safe(reinterpret_cast<const char*>(packed.data()),
                               reinterpret_cast<char*>(plain.data()), static_cast<int>(packed.size()),
                               static_cast<int>(plain.size())) == static_cast<int>(plain.size());
  }
  return ZSTD_decompress(plain.data(), plain.size(), packed.data(), packed.size()) == plain.size();
}

void append(std::vector<std::byte>& to, const void* from, std::size_t bytes) {
  const auto* first = static_cast<const std::byte*>(from);
  to.insert(to.end(), first, first + bytes);
}

struct StoredGroup {
  std::uint32_t tile_count;
  std::uint32_t packed_bytes;
};

// The packed sizes of a group's head and parts, in front of them.
using GroupSizes = std::array<std::uint32_t, 1 + kPlainParts>;

// A group of codec `rice`: the packed bytes of its head, these, and its body.
void pack_rice_group(const TileGroup& group, std::span<const std::byte> payload, PackingTools& tools,
                     std::vector<std::byte>& packed) {
  const RiceGroup coded = encode_rice(group, payload, tools.room);
  const std::vector<std::byte> head = compress({CodecId::zstd, 0}, coded.head, tools);
  const auto head_bytes = static_cast<std::uint32_t>(head.size());
  packed.clear();
  packed.reserve(sizeof head_bytes + head.size() + coded.planes.size() + coded.levels.size());
  append(packed, &head_bytes, sizeof head_bytes);
  for (const std::span<const std::byte> part : {std::span(head), coded.planes, coded.levels})
    append(packed, part.data(), part.size());
}

bool unpack_rice_group(const TileGroup& group, std::span<const std::byte> packed, std::span<std::byte> payload) {
  std::uint32_t head_bytes;
  if (packed.size() < sizeof head_bytes) return false;
  std::memcpy(&head_bytes, packed.data(), sizeof head_bytes);
  packed = packed.subspan(sizeof head_bytes);
  if (head_bytes > packed.size()) return false;
  std::vector<std::byte> head(rice_head_bytes(group));
  return decompress(CodecId::zstd, packed.first(head_bytes), head) &&
         decode_rice(group, head, packed.subspan(head_bytes), payload);
}

void pack_group(const Codec& codec, const TileGroup& group, std::span<const std::byte> payload, PackingTools& tools,
                std::vector<std::byte>& packed) {
  if (codec.id == CodecId::rice) {
    pack_rice_group(group, payload, tools, packed);
    return;
  }
  const PlainGroup plain = predict(group, payload);
  GroupSizes sizes{};
  packed.assign(sizeof sizes, std::byte{0});
  const auto add = [&](std::size_t at, std::span<const std::byte> part) {
    if (part.empty()) return;
    const std::vector<std::byte> bytes = compress(codec, part, tools);
    sizes[at] = static_cast<std::uint32_t>(bytes.size());
    packed.insert(packed.end(), bytes.begin(), bytes.end());
  };
  add(0, plain.head);
  for (std::size_t part = 0; part < kPlainParts; ++part) add(1 + part, plain.parts[part]);
  std::memcpy(packed.data(), sizes.data(), sizeof sizes);
  packed.shrink_to_fit();  // it grew part by part
}

bool unpack_group(CodecId codec, const TileGroup& group, std::span<const std::byte> packed,
                  std::span<std::byte> payload) {
  if (codec == CodecId::rice) return unpack_rice_group(group, packed, payload);
  PlainGroup plain;
  GroupSizes sizes;
  if (packed.size() < sizeof sizes) return false;
  std::memcpy(sizes.data(), packed.data(), sizeof sizes);
  packed = packed.subspan(sizeof sizes);
  const auto take = [&](std::size_t at, std::uint64_t bytes, std::vector<std::byte>& part) {
    if (sizes[at] > packed.size() || (bytes == 0) != (sizes[at] == 0)) return false;
    part.resize(bytes);
    const auto from = packed.first(sizes[at]);
    packed = packed.subspan(sizes[at]);
    return bytes == 0 || decompress(codec, from, part);
  };
  if (!take(0, head_bytes(group), plain.head)) return false;
  const auto bytes = part_bytes(group, plain.head);
  if (!bytes) return false;
  for (std::size_t part = 0; part < kPlainParts; ++part) {
    if (!take(1 + part, (*bytes)[part], plain.parts[part])) return false;
  }
  if (!packed.empty()) return false;
  reconstruct(group, plain, payload);
  return true;
}

// Cuts tiles into groups of about kGroupBytes.
std::vector<std::uint32_t> group_sizes(std::span<const TileEntry> entries, const BlockGeometry& geometry) {
  std::vector<std::uint32_t> sizes;
  std::uint64_t bytes = kGroupBytes;
  for (const TileEntry& entry : entries) {
    const std::uint64_t body = geometry.body_bytes(entry);
    if (bytes + body > kGroupBytes) {
      sizes.push_back(0);
      bytes = 0;
    }
    bytes += body;
    ++sizes.back();
  }
  return sizes;
}

[[noreturn]] void fail_damaged() { throw InputError("its packed payload is damaged"); }

// Reads numbers from the front of a stored payload.
class StoredReader {
 public:
  explicit StoredReader(std::span<const std::byte> stored) : rest_(stored) {}

  template <typename T>
  T take() {
    T value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  std::span<const std::byte> take(std::uint64_t bytes) {
    if (bytes > rest_.size()) fail_damaged();
    const auto taken = rest_.first(bytes);
    rest_ = rest_.subspan(bytes);
    return taken;
  }
  [[nodiscard]] bool is_empty() const { return rest_.empty(); }

 private:
  std::span<const std::byte> rest_;
};

// What stands in front of a stored payload's bodies, and the directory that follows from it.
struct StoredFront {
  std::vector<StoredGroup> groups;
  std::vector<TileEntry> entries;
  StoredReader bodies;
};

StoredFront read_front(CodecId codec, const BlockGeometry& geometry, std::span<const std::byte> stored,
                       std::uint64_t payload_bytes) {
  StoredReader reader(stored);
  const auto group_count = reader.take<std::uint32_t>();
  reader.take<std::uint32_t>();
  const auto group_table = reader.take(std::uint64_t{group_count} * sizeof(StoredGroup));
  std::vector<StoredGroup> groups(group_count);
  if (group_count != 0) std::memcpy(groups.data(), group_table.data(), group_table.size());
  const auto counts_bytes = reader.take<std::uint32_t>();
  reader.take<std::uint32_t>();
  std::vector<std::uint32_t> counts(geometry.tile_count);
  if (!decompress(general_codec({codec, 0}).id, reader.take(counts_bytes), std::as_writable_bytes(std::span(counts)))) {
    fail_damaged();
  }

  // Offsets again: bodies lie one behind the other.
  std::vector<TileEntry> entries(geometry.tile_count);
  std::uint64_t offset = geometry.directory_bytes();
  for (std::size_t tile = 0; tile < entries.size(); ++tile) {
    entries[tile] = {static_cast<std::uint32_t>(offset / kBlockAlignment), counts[tile]};
    const TileEntry& entry = entries[tile];
    if (const std::string flaw = geometry.flaw_of(entry); !flaw.empty()) {
      throw InputError(format("tile {} {}", tile, flaw));
    }
    offset += geometry.body_bytes(entry);
  }
  if (offset != payload_bytes) fail_damaged();
  return {std::move(groups), std::move(entries), reader};
}

}  // namespace

Codec Codec::parse(std::string_view text) {
  if (text == "none") return {CodecId::none, 0};
  if (text == "rice") return {CodecId::rice, 0};
  if (text == "lz4") return {CodecId::lz4, 0};
  if (text == "zstd") return {CodecId::zstd, 0};
  constexpr std::string_view kZstd = "zstd:";
  if (text.starts_with(kZstd)) {
    const std::string_view number = text.substr(kZstd.size());
    int level = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), level);
    if (error == std::errc() && end == number.data() + number.size() && level >= 1 && level <= 19) {
      return {CodecId::zstd, level};
    }
  }
  throw UsageError(format("codec '{}' is not known; choose none, rice, lz4, zstd or zstd:1 … zstd:19", text));
}

std::string Codec::text() const {
  switch (id) {
    case CodecId::none: return "none";
    case CodecId::rice: return "rice";
    case CodecId::lz4: return "lz4";
    case CodecId::zstd: return level == 0 ? "zstd" : format("zstd:{}", level);
  }
  return {};
}

bool pack(const Codec& codec, const BlockGeometry& geometry, std::span<const std::byte> payload,
          std::vector<std::vector<std::byte>>& parts, std::uint32_t max_threads, const ReportedProgress& progress,
          std::uint64_t too_many) {
  if (codec.id == CodecId::none) {
    parts.assign(1, {payload.begin(), payload.end()});
    return payload.size() < too_many;
  }
  std::vector<TileEntry> entries(geometry.tile_count);
  std::memcpy(entries.data(), payload.data(), entries.size() * sizeof(TileEntry));
  std::vector<std::uint32_t> counts;
  counts.reserve(entries.size());
  for (const TileEntry& entry : entries) counts.push_back(entry.count);

  const std::vector<std::uint32_t> sizes = group_sizes(entries, geometry);
  std::vector<std::size_t> firsts(sizes.size(), 0);
  for (std::size_t g = 1; g < sizes.size(); ++g) firsts[g] = firsts[g - 1] + sizes[g - 1];
  parts.resize(1 + sizes.size());
  PackedBytes packed_bytes(progress, payload.size());
  std::atomic<std::uint64_t> bytes{0};
  parallel_for_with(
      sizes.size(), [&] { return PackingTools(packed_bytes); },
      [&](std::uint64_t g, PackingTools& tools) {
        packed_bytes.add(0);
        const TileGroup group{std::span(entries).subspan(firsts[g], sizes[g]), geometry};
        if (bytes >= too_many) return;
        pack_group(codec, group, payload, tools, parts[1 + g]);
        bytes += parts[1 + g].size();
      },
      max_threads);
  if (bytes >= too_many) return false;

  std::vector<std::byte>& front = parts.front();
  front.clear();
  const std::array<std::uint32_t, 2> head{static_cast<std::uint32_t>(sizes.size()), 0};
  append(front, head.data(), sizeof head);
  for (std::size_t g = 0; g < sizes.size(); ++g) {
    const StoredGroup group{sizes[g], static_cast<std::uint32_t>(parts[1 + g].size())};
    append(front, &group, sizeof group);
  }
  PackingTools tools(packed_bytes);
  const std::vector<std::byte> packed_counts =
      compress(general_codec(codec), std::as_bytes(std::span(counts)), tools);
  const std::array<std::uint32_t, 2> counts_head{static_cast<std::uint32_t>(packed_counts.size()), 0};
  append(front, counts_head.data(), sizeof counts_head);
  append(front, packed_counts.data(), packed_counts.size());
  return bytes + front.size() < too_many;
}

std::vector<TileEntry> unpack_directory(CodecId codec, const BlockGeometry& geometry,
                                        std::span<const std::byte> stored, std::uint64_t payload_bytes) {
  if (codec != CodecId::none) return read_front(codec, geometry, stored, payload_bytes).entries;
  std::vector<TileEntry> entries(geometry.tile_count);
  if (stored.size() < geometry.directory_bytes()) fail_damaged();
  std::memcpy(entries.data(), stored.data(), entries.size() * sizeof(TileEntry));
  return entries;
}

void unpack(CodecId codec, const BlockGeometry& geometry, std::span<const std::byte> stored,
            std::span<std::byte> payload, const WantsTiles& wants) {
  if (codec == CodecId::none) {
    if (stored.size() != payload.size()) fail_damaged();
    std::memcpy(payload.data(), stored.data(), stored.size());
    return;
  }
  StoredFront front = read_front(codec, geometry, stored, payload.size());
  std::memset(payload.data(), 0, geometry.directory_bytes());
  std::memcpy(payload.data(), front.entries.data(), front.entries.size() * sizeof(TileEntry));

  struct PackedGroup {
    std::span<const TileEntry> tiles;
    std::span<const std::byte> bytes;
  };
  std::vector<PackedGroup> wanted;
  std::size_t next = 0;
  for (const StoredGroup& group : front.groups) {
    const std::span<const std::byte> bytes = front.bodies.take(group.packed_bytes);
    if (group.tile_count > front.entries.size() - next) fail_damaged();
    const std::size_t first = std::exchange(next, next + group.tile_count);
    if (wants && !wants(first, next)) continue;
    wanted.push_back({std::span(front.entries).subspan(first, group.tile_count), bytes});
  }
  if (next != front.entries.size() || !front.bodies.is_empty()) fail_damaged();
  std::atomic<bool> good{true};
  parallel_for(wanted.size(), [&](std::uint64_t g) {
    const TileGroup group{wanted[g].tiles, geometry};
    if (!unpack_group(codec, group, wanted[g].bytes, payload)) good = false;
  });
  if (!good) fail_damaged();
}

}  // namespace nutik::tik
