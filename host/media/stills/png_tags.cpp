#include "media/stills/stills.hpp"

#include <algorithm>

#include "capture/format.hpp"
#include "media/formats/coding_points.hpp"
#include "media/formats/file_kinds.hpp"
#include "system/mapped_file.hpp"

namespace nutik::stills {
// Chunks: u32 length, four letters, so many bytes, a checksum.
PngTags read_png_tags(const std::filesystem::path& file) {
  constexpr std::size_t kSignature = 8, kFrame = 12, kData = 8;
  constexpr double kGammaParts = 100'000;
  const MappedFile mapped(file);
  const std::string_view bytes(reinterpret_cast<const char*>(mapped.bytes().data()), mapped.bytes().size());
  PngTags tags;
  if (!bytes.starts_with("\x89PNG")) return tags;
  bool has_coding_points = false;
  for (std::size_t at = kSignature; at + kFrame <= bytes.size();) {
    const auto length = static_cast<std::uint32_t>(big_endian(bytes, at, 4));
    const std::string_view name = bytes.substr(at + 4, 4), data = bytes.substr(at + kData, length);
    if (data.size() < length) break;
    if (name == "eXIf") tags.orientation = exif_orientation(data);
    if (name == "tRNS") tags.has_clear_code = true;
    if (name == "cICP" && length == 4) {
      has_coding_points = true;
      tags.primaries = primaries_of_coding_point(static_cast<unsigned char>(data[0]));
      tags.transfer = transfer_of_coding_point(static_cast<unsigned char>(data[1]));
    } else if (name == "sRGB" && !has_coding_points) {
      tags.transfer = Transfer::srgb();
      tags.primaries = Primaries::bt709;
    } else if (name == "gAMA" && length == 4) {
      tags.unread_transfer = format("gamma {:.4g}", kGammaParts / static_cast<double>(std::max<std::uint64_t>(big_endian(data, 0, 4), 1)));
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
