#include "media/stills/stills.hpp"

#include <algorithm>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"
#include "media/formats/coding_points.hpp"

namespace nutik::stills {
namespace {

// Primaries, transfer function, matrix and range, a byte each. Where both of the first are known, they go before what
// other chunks say. Throws InputError where the codes are none that are read.
bool follow_coding_points(PngTags& tags, std::string_view points, std::uint64_t bits, const std::string& name) {
  const auto number = [&](std::size_t at) { return unsigned{static_cast<unsigned char>(points[at])}; };
  if (number(2) != 0) {
    throw InputError(format("{} cannot be read: its cICP names matrix {}, of codes that are not RGB; save it as RGB",
                            name, number(2)));
  }
  if (number(3) == 0) {
    const double unit = bits == 16 ? 256 : 1, percent = 100 / (256 * unit - 1);
    throw InputError(format("{} cannot be read: its cICP says limited range, and stills of full range are read: "
                            "magick IN.png -level {:.5f}%,{:.5f}% -depth 16 OUT.png makes one; then state its transfer",
                            name, 16 * unit * percent, 235 * unit * percent),
                     {Setting::transfer});
  }
  const auto primaries = primaries_of_coding_point(number(0));
  const auto transfer = transfer_of_coding_point(number(1));
  const auto unread = [&](std::size_t at) {
    return number(at) == kUnnamedPrimaries ? std::string() : format("number {} of H.273", number(at));
  };
  if (!primaries) tags.unread_primaries = unread(0);
  if (!transfer) tags.unread_transfer = unread(1);
  const bool are_known = primaries && transfer;
  if (are_known || !tags.primaries) tags.primaries = primaries;
  if (are_known || !tags.transfer) tags.transfer = transfer;
  return are_known;
}

}  // namespace

// Chunks: u32 length, four letters, so many bytes, a checksum.
PngTags read_png_tags(std::span<const std::byte> png, const std::string& file) {
  constexpr std::size_t kSignature = 8, kFrame = 12, kData = 8, kBits = 24;
  constexpr double kParts = 100'000;
  const std::string_view bytes = as_text(png);
  PngTags tags;
  bool has_coding_points = false;
  for (std::size_t at = kSignature; at + kFrame <= bytes.size();) {
    const auto length = static_cast<std::uint32_t>(big_endian(bytes, at, 4));
    const std::string_view name = bytes.substr(at + 4, 4), data = bytes.substr(at + kData, length);
    if (data.size() < length) break;
    if (name == "cICP" && length == 4) {
      has_coding_points = follow_coding_points(tags, data, big_endian(bytes, kBits, 1), file);
    } else if (name == "sRGB" && !has_coding_points) {
      tags.transfer = Transfer::srgb();
      tags.primaries = Primaries::bt709;
    } else if (name == "gAMA" && length == 4 && tags.unread_transfer.empty()) {
      tags.unread_transfer =
          format("gamma {:.4g}", kParts / static_cast<double>(std::max<std::uint64_t>(big_endian(data, 0, 4), 1)));
    } else if (name == "cHRM" && length == 32 && !tags.primaries && !has_coding_points) {
      // White, red, green and blue.
      const auto at = [&](std::size_t each) {
        const auto number = [&](std::size_t from) {  // of some cameras' blue y is below 0
          return static_cast<std::int32_t>(big_endian(data, from, 4)) / kParts;
        };
        return std::array{number(8 * each), number(8 * each + 4)};
      };
      const NamedPrimaries named = primaries_at({at(1), at(2), at(3), at(0)});
      tags.primaries = named.known;
      tags.unread_primaries = named.unread;
    } else if (name == "iCCP") {
      tags.has_profile = true;
    } else if (name == "pHYs" && length >= 8) {
      tags.density = {big_endian(data, 0, 4), big_endian(data, 4, 4)};
    }
    at += kFrame + length;
  }
  tags.has_profile &= !has_coding_points;
  return tags;
}

}  // namespace nutik::stills
