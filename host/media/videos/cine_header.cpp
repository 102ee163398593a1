// The parts of a .cine file that are read here, little-endian:
//
//      0  "CI"          file header of 44 bytes
//     20  u32           pictures in the file
//     24  u32           offset of the bitmap header; 16 bytes into it: u32 compression
//     28  u32           offset of the setup; 140 bytes into it: "ST", then u16 length; 772: u32 exposure in us;
//                5732: u32 code of black
//     32  u32           offset of the pictures' offsets, behind the tagged blocks
//
// Tagged blocks follow the setup: u32 size (of all of it), u16 type, u16 reserved, data.
//   1002   u64 for each picture: its time in units of 2^-32 s
//   1003   u32 for each picture: its exposure in the same units
#include "media/videos/cine_header.hpp"

#include <algorithm>
#include <cstring>
#include <span>
#include <string_view>

#include "capture/rational.hpp"
#include "capture/text.hpp"
#include "media/formats/input_kinds.hpp"
#include "system/mapped_file.hpp"

namespace nutik::videos {
namespace {

constexpr std::uint64_t kFileHeaderBytes = 44;
constexpr std::uint64_t kTagHeaderBytes = 8;
constexpr std::uint16_t kTimes = 1002, kExposures = 1003;
constexpr std::uint32_t kPacked12 = 1024;

// A number at an offset; 0 beyond the end.
template <typename T>
T number(std::span<const std::byte> file, std::uint64_t offset) {
  T value = 0;
  if (offset <= file.size() && file.size() - offset >= sizeof(T)) {
    std::memcpy(&value, file.data() + offset, sizeof(T));
  }
  return value;
}

std::int64_t nanoseconds(std::uint64_t fixed_point) {
  return round_half_up(static_cast<int128>(fixed_point) * 1'000'000'000, int128{1} << 32);
}

}  // namespace

std::optional<CineHeader> read_cine_header(const std::filesystem::path& path) {
  const MappedFile mapped(path);
  const auto file = mapped.bytes();
  const std::string_view start = as_text(file);
  if (file.size() < kFileHeaderBytes || !inputs::kPhantom.begins(start)) return std::nullopt;
  const std::uint64_t count = number<std::uint32_t>(file, 20);
  const std::uint64_t setup = number<std::uint32_t>(file, 28);
  const std::uint64_t tags_end = std::min<std::uint64_t>(number<std::uint32_t>(file, 32), file.size());
  CineHeader header;
  header.is_packed_12 =
      number<std::uint32_t>(file, std::uint64_t{number<std::uint32_t>(file, 24)} + 16) == kPacked12;
  if (setup + 144 > file.size() || std::memcmp(file.data() + setup + 140, "ST", 2) != 0) return header;
  std::uint64_t tag = setup + number<std::uint16_t>(file, setup + 142);
  constexpr std::uint64_t kShutter = 772;
  constexpr std::int64_t kNsInUs = 1000;
  if (const auto shutter_us = number<std::uint32_t>(file, setup + kShutter);
      shutter_us > 0 && tag >= setup + kShutter + 4) {
    header.exposed_ns = shutter_us * kNsInUs;
  }
  constexpr std::uint64_t kBlack = 5732;
  if (tag >= setup + kBlack + 4) header.black_code = number<std::uint32_t>(file, setup + kBlack);
  while (tag + kTagHeaderBytes <= tags_end) {
    const std::uint64_t size = number<std::uint32_t>(file, tag), data = tag + kTagHeaderBytes;
    const auto type = number<std::uint16_t>(file, tag + 4);
    if (size < kTagHeaderBytes || size > tags_end - tag) break;
    if (type == kTimes && count > 0 && size - kTagHeaderBytes >= count * 8) {
      const auto first = number<std::uint64_t>(file, data);
      for (std::uint64_t k = 0; k < count; ++k) {
        const auto time = number<std::uint64_t>(file, data + k * 8);
        header.starts_ns.push_back(time < first ? -nanoseconds(first - time) : nanoseconds(time - first));
      }
    }
    if (type == kExposures && count > 0 && size - kTagHeaderBytes >= count * 4) {
      const auto exposed = number<std::uint32_t>(file, data);
      bool alike = exposed > 0;
      for (std::uint64_t k = 1; k < count; ++k) alike &= number<std::uint32_t>(file, data + k * 4) == exposed;
      if (alike) header.exposed_ns = nanoseconds(exposed);
    }
    tag += size;
  }
  return header;
}

}  // namespace nutik::videos
