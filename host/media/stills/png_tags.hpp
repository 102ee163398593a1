// What the chunks of a PNG say of its codes, beside the size and depth that its decoder tells.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "capture/primaries.hpp"
#include "capture/rational.hpp"
#include "capture/transfer.hpp"

namespace nutik::stills {

struct PngTags {
  std::optional<Transfer> transfer;                  // of cICP, else of sRGB
  std::optional<Primaries> primaries;                // likewise
  bool has_profile = false;                          // iCCP, which goes before sRGB and not before cICP
  unsigned orientation = 1;                          // of eXIf, as EXIF numbers them
  std::string unread_transfer;                       // gAMA alone, which programs write without being asked
  std::optional<std::pair<double, double>> density;  // pixels on a length, across and down
};

// Nothing of what is no PNG.
[[nodiscard]] PngTags read_png_tags(const std::filesystem::path& file);

}  // namespace nutik::stills
