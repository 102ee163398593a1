// Kinds of TIFF that other programs write: tiles, a plane for each channel, palettes. libtiff writes them here.
#include "media/stills/tiff_reader.hpp"

#include <gtest/gtest.h>
#include <tiffio.h>

#include <algorithm>
#include <memory>
#include <string>
#include <tuple>

#include "capture/error.hpp"
#include "support/clips.hpp"
#include "support/messages.hpp"
#include "support/scratch.hpp"
#include "support/stills.hpp"

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
  const FilePicture page = *TiffReader(scratch / "a.tif").next();
  EXPECT_TRUE(page.has_palette);
  const Picture& picture = page.picture;
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
                             {"its colours are " + std::string(name), "their transfer function is srgb"});
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
  const auto story_in = [](const std::string& unit) {
    return read_tiff_story("ImageJ=1.53t\nimages=5\nfps=7\nfinterval=2" + unit + "\nloop=false\n", {1, 1, 1}, "");
  };
  for (const auto& [unit, rate] : {std::pair("", Rational{1, 2}),
                                   {"\ntunit=sec", {1, 2}},
                                   {"\ntunit=ms", {500, 1}},
                                   {"\ntunit=us", {500'000, 1}},
                                   {"\ntunit=\xC2\xB5s", {500'000, 1}},
                                   {"\ntunit=ns", {500'000'000, 1}},
                                   {"\ntunit=minutes", {1, 120}},
                                   {"\ntunit=hr", {1, 7200}}})
    EXPECT_EQ(story_in(unit).rate, rate) << unit;
  const TiffStory other = story_in("\ntunit=fortnight");
  EXPECT_EQ(other.rate, std::nullopt) << "neither of another unit, nor that at which it is shown";
  EXPECT_EQ(other.rate_doubt, "ImageJ's description has pictures '2 fortnight' apart, which is not read");
}

// As programs print doubles, and floats as doubles.
TEST(TiffStory, TakesTheRateThatALongNumberWas) {
  for (const auto& [text, rate] : {std::pair("finterval=0.016666666666666666", Rational{60, 1}),
                                   {"finterval=3.3333333333333335E-4", {3000, 1}},
                                   {"finterval=0.0020000000949949026", {500, 1}},
                                   {"finterval=0.30000000000000004", {10, 3}},
                                   {"fps=29.97002997002997", {30'000, 1001}},
                                   {"finterval=0.0333", {10'000, 333}}})
    EXPECT_EQ(read_tiff_story("ImageJ=1.53t\n" + std::string(text) + "\n", {1, 1, 1}, "").rate, rate) << text;
}

std::string ome(const std::string& sizes, const std::string& inside = "") {
  return "<?xml version=\"1.0\"?><!-- <Pixels SizeC=\"3\"> --><OME><Image><Pixels " + sizes + " Type=\"uint16\">" +
         inside + "</Pixels></Image></OME>";
}

TEST(TiffStory, OfOmeIsReadAsXml) {
  const auto story = [](const std::string& text) { return read_tiff_story(text, {1, 1, 1}, "a.ome.tif"); };
  const TiffStory plain =
      story(ome("PhysicalSizeZ=\"5.0\" SizeC=\"1\" SizeZ=\"1\" SizeT=\"4\" TimeIncrement=\"2\" "
                "TimeIncrementUnit=\"ms\" SignificantBits=\"12\""));
  EXPECT_EQ(std::tuple(plain.pictures, plain.refused, plain.rate, plain.white),
            std::tuple(4U, std::string(), std::optional(Rational{500, 1}), std::optional(4095U)));
  const std::string mixed = "holds 2 channels, 5 moments, as its description by OME says, and its pages are not";
  for (const std::string& text :
       {ome("SizeC='2' Name='a > b' SizeT='5'"), ome("\n SizeT = \"5\"\tSizeC=\"2\""),
        std::string("<OME:OME><OME:Pixels SizeC=\"2\" SizeT=\"5\"/></OME:OME>")})
    EXPECT_TRUE(story(text).refused.starts_with(mixed)) << text << story(text).refused;
  EXPECT_TRUE(story(ome("SizeZ=\"4\" SizeT=\"1\"")).refused.starts_with("holds 4 slices in depth"));
  EXPECT_TRUE(story("<OME><BinaryOnly MetadataFile=\"b.ome\"/></OME>").refused.starts_with(
      "holds pages that another file describes, b.ome"));
  EXPECT_TRUE(story("<OME><Pixels SizeT=\"2\"/><Pixels SizeT=\"2\"/></OME>").refused.starts_with("holds 2 images"));
  for (const char* text : {"<OME", "<OME><Pixels SizeC=\"", "<OME><Pixels =", "<OME><Pixels SizeC", "<OME><!-- "})
    EXPECT_EQ(story(text).rate, std::nullopt) << text;
}

// Each file of a set describes all: what counts is what this one holds, also under another name.
TEST(TiffStory, OfOmeFollowsTheFilesThatItNames) {
  const auto data = [](const char* first, int planes, const char* file) {
    return "<TiffData FirstC=\"" + std::string(first) + "\" FirstT=\"0\" PlaneCount=\"" + std::to_string(planes) +
           "\"><UUID FileName=\"" + file + "\"/></TiffData>";
  };
  const std::string sizes = "SizeC=\"2\" SizeT=\"3\"";
  const auto refused = [&](const std::string& inside, const char* file) {
    return !read_tiff_story(ome(sizes, inside), {1, 1, 1}, file).refused.empty();
  };
  EXPECT_FALSE(refused(data("0", 3, "a.tif") + data("1", 3, "b.tif"), "b.tif"));
  EXPECT_FALSE(refused(data("0", 3, "a.tif") + data("1", 3, "b.tif"), "renamed.tif"));
  EXPECT_TRUE(refused(data("0", 6, "a.tif"), "a.tif"));
  EXPECT_TRUE(refused(data("0", 1, "a.tif") + data("1", 1, "a.tif") + data("0", 1, "a.tif"), "a.tif"));
  const std::string two = ome("SizeT=\"3\"", data("0", 3, "a.tif")) + ome("SizeT=\"3\"", data("0", 3, "b.tif"));
  EXPECT_EQ(read_tiff_story(two, {1, 1, 1}, "b.tif").refused, "");
}

TEST(TiffStory, OfOmeFollowsTimesThatContradictItsInterval) {
  const auto story = [](const std::vector<const char*>& times_ms, const std::string& sizes) {
    std::string planes;
    for (std::size_t k = 0; k < times_ms.size(); ++k) {
      planes += "<Plane TheC=\"0\" TheZ=\"0\" TheT=\"" + std::to_string(k) + "\" DeltaTUnit=\"ms\" DeltaT=\"" +
                times_ms[k] + "\"/>";
    }
    return read_tiff_story(ome("SizeT=\"4\" " + sizes, planes), {1, 1, 1}, "");
  };
  const std::string interval = "TimeIncrement=\"0.01\"";
  const std::vector<std::int64_t> gap{0, 10'000'000, 50'000'000, 60'000'000};
  EXPECT_EQ(story({"5", "15", "55", "65"}, interval).starts_ns, gap);
  EXPECT_EQ(story({"5", "15", "55", "65"}, "").starts_ns, gap);
  for (const auto& [times, sizes] : {std::pair(std::vector{"0", "11", "20", "30"}, interval),
                                     {std::vector{"0", "10.1", "20", "30"}, std::string()},
                                     {std::vector{"0", "10", "50"}, interval},
                                     {std::vector{"0", "10", "10", "90"}, interval}}) {
    EXPECT_TRUE(story(times, sizes).starts_ns.empty());
    EXPECT_EQ(story(times, sizes).rate, (Rational{100, 1}));
  }
}

TEST(TiffStory, OfTifffileIsReadAsJson) {
  const auto story = [](const char* text) { return read_tiff_story(text, {1, 1, 1}, ""); };
  EXPECT_EQ(story(R"({"shape": [20, 12, 17]})").pictures, 20U);
  EXPECT_EQ(story(R"({"axes": "TYX", "shape": [20, 12, 17]})").refused, "");
  for (const auto& [text, refused] :
       {std::pair(R"({"axes": "TCYX", "shape": [10, 2, 12, 17]})", "holds pictures in 10 x 2, as its description by"),
        {R"({"axes": "CYX", "shape": [2, 12, 17]})", "holds 2 channels"},
        {R"({"axes": "ZYX", "shape": [2, 12, 17]})", "holds 2 slices in depth"}})
    EXPECT_TRUE(story(text).refused.starts_with(refused)) << story(text).refused;
  for (const char* text : {"{", "{}", R"({"shape": 3})", R"({"shape": ["a", -1, 2.5, 4]})"})
    EXPECT_EQ(story(text).refused, "") << text;
}

TEST(TiffClip, IsWhatItsProgramSays) {
  const Scratch scratch;
  const auto stills = random_stills({17, 9, 1}, 4095, 4, 1);
  const auto stack = [&](const TiffOptions& options) { return scratch.write("a.tif", tiff_file(stills, options)); };
  const auto refuse = [](const std::filesystem::path& path, const std::vector<std::string>& parts) {
    expect_error<InputError>([&] { open_test_clip(path); }, parts);
  };
  const std::string channels = "ImageJ=1.53t\nimages=4\nchannels=2\nframes=2\n";
  const std::string ome = "<OME><Pixels SizeC=\"2\" SizeT=\"2\" SignificantBits=\"12\"/></OME>";
  const std::string is_signed = "ImageJ=1.53t\nimages=4\nslices=4\ncf=0\nc0=-32768.0\nc1=1.0\n";
  for (const bool in_one : {false, true}) {
    refuse(stack({.description = channels, .in_one = in_one}), {"a.tif holds 2 channels, 2 moments, as its"});
    refuse(stack({.description = ome, .in_one = in_one}), {"a.tif holds 2 channels, 2 moments, as its"});
    refuse(stack({.description = is_signed, .in_one = in_one}), {"its values are signed", "of 32 bits"});
  }
  refuse(stack({.tags = {{259, {3, 1, 34712}}}}), {"its compression, number 34712, is none that is read here"});
  // MetaMorph's planes, each with a fraction.
  const TiffOptions planes{.in_one = true, .tags = {{33629, {5, 4, 8}}}};
  expect_codes(*open_test_clip(stack(planes)), stills);
  refuse(scratch.write("one.stk", tiff_file({stills[0]}, planes)), {"holds 4 pictures", "scattered"});

  const auto slices = open_test_clip(stack({.description = "ImageJ=1.53t\nimages=3\nslices=3\n"}));
  const std::string notes = notes_of(*slices);
  for (const char* note : {"the pictures slices: they are taken", "counts its pictures as 3, and the file holds 4"})
    EXPECT_NE(notes.find(note), std::string::npos) << notes;

  const std::string json = R"({"BitDepth": 12})";
  TiffOptions micro_manager{.description = json};
  for (int pass = 0; pass < 2; ++pass) {  // the tag's text is the description
    const auto at = static_cast<std::uint32_t>(tiff_file(stills, micro_manager).find(json));
    micro_manager.tags[51123] = {2, static_cast<std::uint32_t>(json.size() + 1), at};
  }
  for (const TiffOptions& options :
       {micro_manager, TiffOptions{.description = "<OME><Pixels SizeT=\"4\" SignificantBits=\"12\"/></OME>"}})
    EXPECT_EQ(open_test_clip(stack(options))->info().format.white_code, 4095u);
}

}  // namespace
}  // namespace nutik::test
