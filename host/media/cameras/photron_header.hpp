// What Photron's cameras write beside their pictures (.cih: text, .cihx: XML): how fast they filmed, how long each
// picture was exposed, and how the pictures of a .mraw are stored.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "capture/rational.hpp"

namespace nutik {

// How a .mraw stores its pictures. A number is 0, a text empty, where the header does not say it.
struct PhotronPictures {
  std::uint64_t width = 0;
  std::uint64_t height = 0;
  std::uint64_t count = 0;
  std::uint64_t pixel_bits = 0;  // of all channels
  std::uint64_t depth = 0;       // how many bits of a value count
  std::string side;              // which ones: lower, higher
  std::string colour;            // mono, raw, color, …
  std::string file_format;       // mraw, …
  bool is_processed = false;     // the camera's program changed the values when it saved them
};

struct PhotronHeader {
  std::filesystem::path file;
  std::optional<Rational> rate;            // pictures a second, of those that were saved
  std::optional<std::int64_t> exposed_ns;  // of each
  std::uint64_t step = 1;                  // one of so many was saved
  std::string device;
  PhotronPictures pictures;
};

// What a header's text says, texts in small letters; whatever it does not say, or what makes no sense, is left out.
[[nodiscard]] PhotronHeader parse_photron_header(std::string_view text);

// Whether a file's name is that of a header.
[[nodiscard]] bool is_photron_header(const std::filesystem::path& path);

// The headers of a file of pictures, which have its name: a .cih, then a .cihx, unless it is absent.
[[nodiscard]] std::vector<std::filesystem::path> headers_beside(const std::filesystem::path& pictures);

// Throws InputError where the file cannot be read.
[[nodiscard]] PhotronHeader read_photron_header(const std::filesystem::path& file);

// The header of a file of pictures, which has its name, or the only one in a folder of them. None where there is
// none, or it tells no rate.
[[nodiscard]] std::optional<PhotronHeader> photron_header_of(const std::filesystem::path& pictures);

}  // namespace nutik
