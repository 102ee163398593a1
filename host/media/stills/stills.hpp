// Private to the module nutik-stills.so: how stills are decoded. media/module.hpp says what its entries do.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "capture/picture.hpp"
#include "capture/primaries.hpp"
#include "capture/transfer.hpp"
#include "media/clip.hpp"
#include "media/stills/stills_table.hpp"
#include "system/output_file.hpp"

namespace nutik::stills {

// What the chunks of a PNG say of its codes, beside the size and depth that its decoder tells.
struct PngTags {
  std::optional<Transfer> transfer;                  // of cICP, else of sRGB
  std::optional<Primaries> primaries;                // likewise, else of cHRM
  bool has_profile = false;                          // iCCP, which goes before sRGB and not before cICP
  std::string unread_transfer;                       // of cICP, else gAMA alone, which nobody asks programs for
  std::string unread_primaries;                      // of cICP, else cHRM
  std::optional<std::pair<double, double>> density;  // pixels on a length, across and down
};

// Throws InputError naming `name` where its codes are of limited range, or no RGB.
[[nodiscard]] PngTags read_png_tags(std::span<const std::byte> png, const std::string& name);

[[nodiscard]] StillTimes read_exif_times(const std::filesystem::path& file);

// The orientation that a JPEG's EXIF data state, 1 … 8; 1 where they state none.
[[nodiscard]] unsigned exif_orientation(const std::filesystem::path& jpeg);

void write_exr(OutputFile& file, const Picture& picture, const std::string& text, bool as_half);
void write_exr_layers(OutputFile& file, std::span<const PictureLayer> layers);
// The primaries whose red, green, blue and white have these chromaticities, as nearly as files state them; else these,
// for people.
struct NamedPrimaries {
  std::optional<Primaries> known = std::nullopt;
  std::string unread = {};
};
[[nodiscard]] NamedPrimaries primaries_at(const std::array<std::array<double, 2>, 4>& points);

struct ExrPicture {
  Picture light;
  NamedPrimaries primaries;
  std::string left_out;  // channels beside R, G and B or one of grey (media/clip.hpp)
  double pixel_aspect = 1;
};
// Light in light32, and what its file says of it. Throws InputError where it has none of these channels, or other
// pixels than its picture.
[[nodiscard]] ExrPicture read_exr(const std::filesystem::path& file);
[[nodiscard]] std::optional<std::string> read_exr_text(const std::filesystem::path& file,
                                                       const char* keyword);

}  // namespace nutik::stills
