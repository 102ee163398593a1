#include "media/stills/picture_files.hpp"

#include <tiffio.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/formats/colour_profile.hpp"

namespace nutik {
namespace {

constexpr std::uint64_t kLargestClassicTiff = 4'000'000'000;

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};

}  // namespace

std::optional<std::string> read_tiff_description(const std::filesystem::path& path) {
  TIFFSetErrorHandler(nullptr);
  TIFFSetWarningHandler(nullptr);
  const std::unique_ptr<TIFF, CloseTiff> tiff(TIFFOpen(path.c_str(), "rm"));
  if (!tiff) throw InputError(format("{} cannot be read: it is no TIFF, or was cut off", path.string()));
  const char* text = nullptr;
  if (TIFFGetField(tiff.get(), TIFFTAG_IMAGEDESCRIPTION, &text) == 0 || text == nullptr) return std::nullopt;
  return text;
}

void write_tiff(const std::filesystem::path& path, const Picture& picture, const std::string& text) {
  TIFFSetErrorHandler(nullptr);  // what matters is thrown
  TIFFSetWarningHandler(nullptr);
  const std::unique_ptr<TIFF, CloseTiff> tiff(
      TIFFOpen(path.c_str(), picture.bytes.size() > kLargestClassicTiff ? "w8" : "w"));
  const auto fail = [&] { throw OutputError(format("the TIFF cannot be written: {}", path.string())); };
  if (!tiff) fail();
  const Shape& shape = picture.shape;
  const std::size_t bytes = value_bytes(picture.type);
  TIFFSetField(tiff.get(), TIFFTAG_IMAGEWIDTH, shape.width);
  TIFFSetField(tiff.get(), TIFFTAG_IMAGELENGTH, shape.height);
  TIFFSetField(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, shape.channels);
  TIFFSetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, static_cast<int>(bytes * 8));
  TIFFSetField(tiff.get(), TIFFTAG_SAMPLEFORMAT,
               holds_codes(picture.type) ? SAMPLEFORMAT_UINT : SAMPLEFORMAT_IEEEFP);
  TIFFSetField(tiff.get(), TIFFTAG_PHOTOMETRIC,
               shape.channels == 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff.get(), TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff.get(), TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  TIFFSetField(tiff.get(), TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  if (picture.pixel_aspect != Rational{1, 1}) {
    // Pixels for the same length, of no unit: the wider a pixel, the fewer.
    TIFFSetField(tiff.get(), TIFFTAG_RESOLUTIONUNIT, RESUNIT_NONE);
    TIFFSetField(tiff.get(), TIFFTAG_XRESOLUTION, static_cast<double>(picture.pixel_aspect.denominator));
    TIFFSetField(tiff.get(), TIFFTAG_YRESOLUTION, static_cast<double>(picture.pixel_aspect.numerator));
  }
  const std::vector<std::byte> profile = colour_profile(picture);
  if (!profile.empty()) {
    TIFFSetField(tiff.get(), TIFFTAG_ICCPROFILE, static_cast<std::uint32_t>(profile.size()), profile.data());
  }
  if (!text.empty()) TIFFSetField(tiff.get(), TIFFTAG_IMAGEDESCRIPTION, text.c_str());
  TIFFSetField(tiff.get(), TIFFTAG_ROWSPERSTRIP, TIFFDefaultStripSize(tiff.get(), 0));
  const std::size_t row_bytes = std::size_t{shape.width} * shape.channels * bytes;
  std::vector<std::byte> row(row_bytes);  // libtiff may change what it is given
  for (std::uint32_t y = 0; y < shape.height; ++y) {
    std::copy_n(picture.bytes.begin() + static_cast<std::ptrdiff_t>(y * row_bytes), row_bytes, row.begin());
    if (TIFFWriteScanline(tiff.get(), row.data(), y, 0) < 0) fail();
  }
  if (TIFFFlush(tiff.get()) == 0) fail();
}

}  // namespace nutik
