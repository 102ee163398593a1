// Kinds of TIFF that other programs write: tiles, a plane for each channel, palettes. libtiff writes them here.
#include "media/stills/tiff_reader.hpp"

#include <gtest/gtest.h>
#include <tiffio.h>

#include <algorithm>
#include <memory>
#include <string>
#include <tuple>

#include "capture/error.hpp"
#include "support/messages.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

// No multiple of a tile's side.
constexpr std::uint32_t kPageWidth = 41, kPageHeight = 23, kTileSide = 16;

struct CloseTiff {
  void operator()(TIFF* file) const { TIFFClose(file); }
};
using TiffFile = std::unique_ptr<TIFF, CloseTiff>;

std::uint32_t drawn_code(std::uint32_t x, std::uint32_t y, std::uint32_t channel) {
  return x * 5 + y * 3 + channel * 20;
}

struct TiffKind {
  std::uint16_t bits, channels;
  bool tiled, separate;
};

TiffFile begun(const std::filesystem::path& path, const TiffKind& kind) {
  TiffFile file(TIFFOpen(path.c_str(), "w"));
  TIFFSetField(file.get(), TIFFTAG_IMAGEWIDTH, kPageWidth);
  TIFFSetField(file.get(), TIFFTAG_IMAGELENGTH, kPageHeight);
  TIFFSetField(file.get(), TIFFTAG_BITSPERSAMPLE, kind.bits);
  TIFFSetField(file.get(), TIFFTAG_SAMPLESPERPIXEL, kind.channels);
  TIFFSetField(file.get(), TIFFTAG_PHOTOMETRIC,
               kind.channels == 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
  TIFFSetField(file.get(), TIFFTAG_PLANARCONFIG, kind.separate ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG);
  TIFFSetField(file.get(), TIFFTAG_COMPRESSION, COMPRESSION_LZW);
  if (kind.tiled) {
    TIFFSetField(file.get(), TIFFTAG_TILEWIDTH, kTileSide);
    TIFFSetField(file.get(), TIFFTAG_TILELENGTH, kTileSide);
  }
  return file;
}

// Codes of a part of the picture, those of `plane` alone where planes are separate.
std::vector<std::uint8_t> packed(const TiffKind& kind, std::uint32_t left, std::uint32_t top, std::uint32_t width,
                                 std::uint32_t height, std::uint32_t plane) {
  std::vector<std::uint8_t> bytes;
  for (std::uint32_t y = top; y < top + height; ++y) {
    for (std::uint32_t x = left; x < left + width; ++x) {
      for (std::uint32_t channel = 0; channel < (kind.separate ? 1 : kind.channels); ++channel) {
        const auto code = static_cast<std::uint16_t>(drawn_code(x, y, kind.separate ? plane : channel));
        bytes.push_back(static_cast<std::uint8_t>(code));
        if (kind.bits == 16) bytes.push_back(static_cast<std::uint8_t>(code >> 8));  // little endian, as here
      }
    }
  }
  return bytes;
}

void write(const std::filesystem::path& path, const TiffKind& kind) {
  const TiffFile file = begun(path, kind);
  for (std::uint16_t plane = 0; plane < (kind.separate ? kind.channels : 1); ++plane) {
    for (std::uint32_t y = 0; y < kPageHeight; y += kind.tiled ? kTileSide : 1) {
      if (!kind.tiled) {
        TIFFWriteScanline(file.get(), packed(kind, 0, y, kPageWidth, 1, plane).data(), y, plane);
        continue;
      }
      for (std::uint32_t x = 0; x < kPageWidth; x += kTileSide) {
        TIFFWriteTile(file.get(), packed(kind, x, y, kTileSide, kTileSide, plane).data(), x, y, 0, plane);
      }
    }
  }
}

class TiffKinds : public testing::TestWithParam<TiffKind> {};

TEST_P(TiffKinds, GiveTheCodesThatTheyHold) {
  const Scratch scratch;
  write(scratch / "a.tif", GetParam());
  TiffReader reader(scratch / "a.tif");
  ASSERT_EQ(reader.page_count(), 1u);
  const FilePicture page = *reader.next();
  EXPECT_FALSE(reader.next());
  const Shape& shape = page.picture.shape;
  ASSERT_EQ(shape, (Shape{kPageWidth, kPageHeight, GetParam().channels}));
  for (std::size_t i = 0; i < shape.value_count(); ++i) {
    const std::uint32_t code = GetParam().bits == 8 ? page.picture.values<std::uint8_t>()[i]
                                                    : page.picture.values<std::uint16_t>()[i];
    const auto pixel = static_cast<std::uint32_t>(i / shape.channels),
               channel = static_cast<std::uint32_t>(i % shape.channels);
    const std::uint32_t expected = drawn_code(pixel % kPageWidth, pixel / kPageWidth, channel);
    ASSERT_EQ(code, GetParam().bits == 8 ? expected & 255 : expected) << "value " << i;
  }
}

TEST_P(TiffKinds, AreRefusedWhereTheyAreDamaged) {
  const Scratch scratch;
  write(scratch / "a.tif", GetParam());
  std::string bytes = read_file(scratch / "a.tif");
  std::fill(bytes.begin() + 8, bytes.begin() + 40, '\xFF');  // of the first strip or tile
  TiffReader reader(scratch.write("b.tif", bytes));
  expect_error<InputError>([&] { return reader.next(); }, {"b.tif cannot be read: it is damaged"});
}

INSTANTIATE_TEST_SUITE_P(All, TiffKinds,
                         testing::Values(TiffKind{8, 1, true, false}, TiffKind{8, 3, true, false},
                                         TiffKind{16, 3, true, false}, TiffKind{16, 1, true, false},
                                         TiffKind{8, 3, true, true}, TiffKind{16, 3, false, true},
                                         TiffKind{8, 3, false, false}));

void write_palette(const std::filesystem::path& path, const std::string& description) {
  const TiffFile file = begun(path, {8, 1, false, false});
  TIFFSetField(file.get(), TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_PALETTE);
  TIFFSetField(file.get(), TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  TIFFSetField(file.get(), TIFFTAG_IMAGEDESCRIPTION, description.c_str());
  std::vector<std::uint16_t> red(256), green(256), blue(256);
  for (std::uint16_t i = 0; i < 256; ++i) {
    red[i] = static_cast<std::uint16_t>(i << 8);
    green[i] = static_cast<std::uint16_t>((255 - i) << 8);
    blue[i] = 0x1200;
  }
  TIFFSetField(file.get(), TIFFTAG_COLORMAP, red.data(), green.data(), blue.data());
  for (std::uint32_t y = 0; y < kPageHeight; ++y) {
    TIFFWriteScanline(file.get(), packed({8, 1, false, false}, 0, y, kPageWidth, 1, 0).data(), y, 0);
  }
}

// A palette's colours, as libtiff shows them: the upper half of 16 bits.
TEST(TiffPalette, GivesItsColours) {
  const Scratch scratch;
  write_palette(scratch / "a.tif", "");
  const Picture picture = TiffReader(scratch / "a.tif").next()->picture;
  ASSERT_EQ(picture.shape, (Shape{kPageWidth, kPageHeight, 3}));
  const auto codes = picture.values<std::uint8_t>();
  for (std::uint32_t y = 0; y < kPageHeight; ++y) {
    for (std::uint32_t x = 0; x < kPageWidth; ++x) {
      const std::uint32_t entry = drawn_code(x, y, 0) & 255, at = (y * kPageWidth + x) * 3;
      ASSERT_EQ(codes[at], entry);
      ASSERT_EQ(codes[at + 1], 255 - entry);
      ASSERT_EQ(codes[at + 2], 0x12);
    }
  }
}

// ImageJ writes one directory for all pictures of a stack: each would be the first.
TEST(TiffPalette, OfPicturesBehindOneAnotherIsRefused) {
  const Scratch scratch;
  write_palette(scratch / "a.tif", "ImageJ=1.53t\nimages=5\nslices=5\n");
  scratch.write("a.tif", read_file(scratch / "a.tif") + std::string(4 * kPageWidth * kPageHeight, '\0'));
  expect_error<InputError>([&] { return TiffReader(scratch / "a.tif"); },
                           {"a.tif holds 5 pictures behind one another, as its description by ImageJ says"});
}

TEST(TiffColours, OfOtherKindsAreNamed) {
  const Scratch scratch;
  for (const auto& [kind, channels, name] :
       {std::tuple{PHOTOMETRIC_SEPARATED, 4, "CMYK"}, {PHOTOMETRIC_CIELAB, 3, "L*a*b*"}}) {
    {
      const TiffFile file = begun(scratch / "a.tif", {8, static_cast<std::uint16_t>(channels), false, false});
      TIFFSetField(file.get(), TIFFTAG_PHOTOMETRIC, kind);
      std::vector<std::uint8_t> row(static_cast<std::size_t>(channels) * kPageWidth);
      for (std::uint32_t y = 0; y < kPageHeight; ++y) TIFFWriteScanline(file.get(), row.data(), y, 0);
    }
    expect_error<InputError>([&] { return TiffReader(scratch / "a.tif").next(); },
                             {"its colours are " + std::string(name)});
  }
}

TEST(TiffPages, ThatAreCopiesOfOthersAreNoMoments) {
  const Scratch scratch;
  {
    const TiffFile file = begun(scratch / "a.tif", {8, 1, false, false});
    for (const std::uint32_t kind : {0U, 0U + FILETYPE_REDUCEDIMAGE, 0U + FILETYPE_MASK, 0U}) {
      for (const auto& [tag, value] : {std::pair{TIFFTAG_IMAGEWIDTH, kPageWidth}, {TIFFTAG_IMAGELENGTH, kPageHeight}})
        TIFFSetField(file.get(), static_cast<std::uint32_t>(tag), value);
      TIFFSetField(file.get(), TIFFTAG_BITSPERSAMPLE, 8);
      TIFFSetField(file.get(), TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
      TIFFSetField(file.get(), TIFFTAG_SUBFILETYPE, kind);
      std::vector<std::uint8_t> row(kPageWidth, static_cast<std::uint8_t>(10 + kind));
      for (std::uint32_t y = 0; y < kPageHeight; ++y) TIFFWriteScanline(file.get(), row.data(), y, 0);
      TIFFWriteDirectory(file.get());
    }
  }
  TiffReader reader(scratch / "a.tif");
  EXPECT_EQ(reader.page_count(), 2U);
  for (int page = 0; page < 2; ++page) EXPECT_EQ(reader.next()->picture.values<std::uint8_t>()[0], 10);
  EXPECT_FALSE(reader.next());
}

TEST(TiffStory, OfImageJCountsTimeInItsUnit) {
  const auto rate_in = [](const std::string& unit) {
    return read_tiff_story("ImageJ=1.53t\nimages=5\nfps=7\nfinterval=2" + unit + "\nloop=false\n", {1, 1, 1}).rate;
  };
  for (const auto& [unit, rate] : {std::pair("", Rational{1, 2}),
                                   {"\ntunit=sec", {1, 2}},
                                   {"\ntunit=ms", {500, 1}},
                                   {"\ntunit=us", {500'000, 1}},
                                   {"\ntunit=\xC2\xB5s", {500'000, 1}},
                                   {"\ntunit=ns", {500'000'000, 1}},
                                   {"\ntunit=min", {1, 120}}})
    EXPECT_EQ(rate_in(unit), rate) << unit;
  EXPECT_EQ(rate_in("\ntunit=hr"), std::nullopt) << "neither of another unit, nor that at which it is shown";
}

}  // namespace
}  // namespace nutik::test
