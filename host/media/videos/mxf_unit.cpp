#include "media/videos/mxf_unit.hpp"
#include "capture/text.hpp"

#include <algorithm>


namespace nutik::videos {
namespace {

using namespace std::string_view_literals;

// An item of MXF (SMPTE ST 336): a key of 16 bytes, the length of the value in one byte or in as many as 0x80 + n says,
// the value. Takes the first from `items`; empty at their end, and where the value is cut off.
struct MxfItem {
  std::string_view key, value;
};

MxfItem take_item(std::string_view& items) {
  constexpr std::size_t kKey = 16;
  if (items.size() <= kKey) return {};
  const auto first = static_cast<unsigned char>(items[kKey]);
  const std::size_t more = first < 0x80 ? 0 : first - 0x80, begin = kKey + 1 + more;
  const std::uint64_t length = more == 0 ? first : big_endian(items, kKey + 1, more);
  if (more > 8 || items.size() < begin || items.size() - begin < length) return {};
  const MxfItem item{items.substr(0, kKey), items.substr(begin, length)};
  items.remove_prefix(begin + length);
  return item;
}

// The value that a set has under a tag: u16 tag, u16 length, value, one behind the other.
std::string_view tagged(std::string_view set, std::uint64_t tag) {
  while (set.size() >= 4) {
    const std::uint64_t length = big_endian(set, 2, 2);
    if (set.size() - 4 < length) break;
    if (big_endian(set, 0, 2) == tag) return set.substr(4, length);
    set.remove_prefix(4 + length);
  }
  return {};
}

// Sony's labels of curves and primaries, which SMPTE registered for it.
std::string sonys_name(std::string_view label) {
  constexpr std::string_view kSonys = "\x06\x0E\x2B\x34\x04\x01\x01\x06\x0E\x06\x04\x01"sv;
  if (!label.starts_with(kSonys)) return {};
  switch (big_endian(label, kSonys.size(), 4)) {
    case 0x01010508: return "s-log2";
    case 0x01010604: return "s-log3";
    case 0x01010605: return "s-log3-cine";
    case 0x01030103: return "s-gamut";
    case 0x01030104: return "s-gamut3";
    case 0x01030105: return "s-gamut3-cine";
    default: return {};
  }
}

// The camera unit's set in ancillary data (SMPTE RDD 18 in ST 436): u16 packets, each of a header of 6 bytes, u32
// bytes, u32 1, then 0x43 0x05, u8 length, u8 number of the message and a part of the items.
std::string unit_items(std::string_view ancillary) {
  constexpr std::size_t kHeader = 14;
  std::string items;
  std::uint64_t packets = big_endian(ancillary, 0, 2);
  ancillary.remove_prefix(std::min<std::size_t>(2, ancillary.size()));
  for (; packets > 0 && ancillary.size() > kHeader; --packets) {
    const std::string_view packet = ancillary.substr(kHeader, big_endian(ancillary, 6, 4));
    if (packet.starts_with("\x43\x05"sv) && packet.size() > 4)
      items += packet.substr(4, std::max<std::uint64_t>(big_endian(packet, 2, 1), 1) - 1);
    ancillary.remove_prefix(kHeader + packet.size());
  }
  return items;
}

}  // namespace

CameraUnit mxf_unit(std::string_view file) {
  constexpr std::string_view kFile = "\x06\x0E\x2B\x34\x02\x05\x01\x01\x0D\x01\x02"sv,
                             kDescriptions = "\x06\x0E\x2B\x34\x02\x53\x01\x01\x0D"sv,
                             kUnits = "\x06\x0E\x2B\x34\x02\x53\x01\x01\x0C"sv,
                             kEssence = "\x06\x0E\x2B\x34\x01\x02\x01"sv, kAncillary = "\x0D\x01\x03\x01\x17"sv;
  constexpr std::uint64_t kCurve = 0x3210, kGamut = 0x3219, kLayout = 0x320C, kRate = 0x8106;
  constexpr int kMaxItems = 4096;  // those of the first picture lie before
  CameraUnit unit;
  if (!file.starts_with(kFile)) return unit;
  bool is_whole = false;
  const auto read = [&](std::string_view set) {
    if (const std::string name = sonys_name(tagged(set, kCurve)); !name.empty()) unit.curve = name;
    if (const std::string name = sonys_name(tagged(set, kGamut)); !name.empty()) unit.gamut = name;
  };
  for (int k = 0; k < kMaxItems; ++k) {
    const MxfItem item = take_item(file);
    if (item.key.empty()) break;
    if (item.key.starts_with(kDescriptions)) {
      is_whole = is_whole || tagged(item.value, kLayout) == "\0"sv;
      read(item.value);
    }
    if (!item.key.starts_with(kEssence) || item.key.substr(8, 5) != kAncillary) continue;
    const std::string items = unit_items(item.value);
    std::string_view left = items;
    for (MxfItem set = take_item(left); !set.key.empty(); set = take_item(left)) {
      if (!set.key.starts_with(kUnits)) continue;
      read(set.value);
      const std::string_view rate = tagged(set.value, kRate);
      const auto parts = [&](std::size_t at) { return static_cast<std::int64_t>(big_endian(rate, at, 4)); };
      if (is_whole && parts(0) > 0 && parts(4) > 0) unit.rate = Rational::of(parts(0), parts(4));
    }
    break;
  }
  return unit;
}

}  // namespace nutik::videos
