// TIFF through libtiff: written uncompressed, so that every program reads it bit for bit.
#include <tiffio.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/formats/colour_profile.hpp"
#include "media/formats/input_kinds.hpp"
#include "system/output_file.hpp"

namespace nutik {

using std::literals::operator""sv;

namespace {

constexpr std::uint64_t kLargestClassicTiff = 4'000'000'000;

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};

// A page; false where it cannot be written.
bool write_page(TIFF* tiff, const OutputFile& file, const Picture& picture, const std::string& text) {
  const Shape& shape = picture.shape;
  const std::size_t bytes = value_bytes(picture.type);
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, shape.width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, shape.height);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, shape.channels);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, static_cast<int>(bytes * 8));
  if (picture.type == ValueType::code16 && picture.white_code < 65'535)
    TIFFSetField(tiff, TIFFTAG_MAXSAMPLEVALUE, static_cast<int>(picture.white_code));
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT,
               holds_codes(picture.type) ? SAMPLEFORMAT_UINT : SAMPLEFORMAT_IEEEFP);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC,
               shape.channels == 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  if (picture.pixel_aspect != Rational{1, 1}) {
    // Pixels for the same length, of no unit: the wider a pixel, the fewer.
    TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_NONE);
    TIFFSetField(tiff, TIFFTAG_XRESOLUTION, static_cast<double>(picture.pixel_aspect.denominator));
    TIFFSetField(tiff, TIFFTAG_YRESOLUTION, static_cast<double>(picture.pixel_aspect.numerator));
  }
  const std::vector<std::byte> profile = colour_profile(picture);
  if (!profile.empty()) {
    TIFFSetField(tiff, TIFFTAG_ICCPROFILE, static_cast<std::uint32_t>(profile.size()), profile.data());
  }
  if (!text.empty()) TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, text.c_str());
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, TIFFDefaultStripSize(tiff, 0));
  const std::size_t row_bytes = std::size_t{shape.width} * shape.channels * bytes;
  std::vector<std::byte> row(row_bytes);  // libtiff may change what it is given
  for (std::uint32_t y = 0; y < shape.height; ++y) {
    file.check();
    std::copy_n(picture.bytes.begin() + static_cast<std::ptrdiff_t>(y * row_bytes), row_bytes, row.begin());
    if (TIFFWriteScanline(tiff, row.data(), y, 0) < 0) return false;
  }
  return true;
}

// Writes `pages` pages of so many bytes each by `write_one`, which says whether it could.
template <typename Write>
void write_pages(const OutputFile& file, std::uint64_t bytes, std::size_t pages, const Write& write_one) {
  TIFFSetErrorHandler(nullptr);  // what matters is thrown
  TIFFSetWarningHandler(nullptr);
  errno = 0;
  const char* const mode = pages * bytes > kLargestClassicTiff ? "w8" : "w";
  const std::unique_ptr<TIFF, CloseTiff> tiff(TIFFOpen(file.temporary_path().c_str(), mode));
  bool is_written = tiff != nullptr;
  for (std::size_t page = 0; is_written && page < pages; ++page)
    is_written = write_one(tiff.get(), page) && (page + 1 == pages || TIFFWriteDirectory(tiff.get()) == 1);
  if (is_written && TIFFFlush(tiff.get()) != 0) return;
  if (errno != 0) file.fail();
  throw OutputError("the TIFF cannot be written, and libtiff does not say why");
}

// The first picture's.
std::optional<std::string> read_description(std::span<const std::byte>, const std::filesystem::path& path) {
  TIFFSetErrorHandler(nullptr);
  TIFFSetWarningHandler(nullptr);
  const std::unique_ptr<TIFF, CloseTiff> tiff(TIFFOpen(path.c_str(), "rm"));
  if (!tiff) throw InputError(format("{} cannot be read: it is no TIFF, or was cut off", path.string()));
  const char* text = nullptr;
  if (TIFFGetField(tiff.get(), TIFFTAG_IMAGEDESCRIPTION, &text) == 0 || text == nullptr) return std::nullopt;
  return text;
}

// What values mean as an ICC profile, pixels that are not square as resolution, `text` as ImageDescription.
void write_tiff(OutputFile& file, const Picture& picture, const std::string& text, const FileWishes&) {
  write_pages(file, picture.bytes.size(), 1,
              [&](TIFF* tiff, std::size_t) { return write_page(tiff, file, picture, text); });
}

// Each is a page, described by its text.
void write_tiff_layers(OutputFile& file, std::span<const PictureLayer> layers) {
  write_pages(file, layers.front().values.bytes.size(), layers.size(), [&](TIFF* tiff, std::size_t page) {
    return write_page(tiff, file, layers[page].values, layers[page].text);
  });
}

}  // namespace

constinit const inputs::InputKind inputs::kTiff{
    .name = "TIFF", .starts = {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv}, .extensions = " .tif .tiff ",
    .said = {"ImageJ's or OME's description", "none",
             "as stored, or a palette's colours; white by its bits; of 16 `MaxSampleValue` if all ones, OME's or "
             "Micro-Manager's bits, else 65535 with a note; floats as of OpenEXR",
             "`Orientation`", "left out", "its pages"},
    .has_tags = true, .text = read_description,
    .written = {{.extension = ".tif", .also = ".tiff", .code_bits = 16, .holds_light = true, .holds_double = true,
                 .write = write_tiff, .write_layers = write_tiff_layers}}};

}  // namespace nutik
