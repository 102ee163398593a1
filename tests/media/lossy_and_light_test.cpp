// Pictures as JPEG and OpenEXR, read back by the libraries themselves: their values, and what they say that these mean.
#include <gtest/gtest.h>

#include <cstdio>  // which jpeglib.h needs and does not include

#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <jpeglib.h>
#include <lcms2.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "capture/error.hpp"
#include "media/stills/picture_text.hpp"
#include "media/writers/picture_writer.hpp"
#include "support/clips.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"
#include "system/mapped_file.hpp"

namespace nutik::test {
namespace {

constexpr Shape kShapes[] = {{1, 1, 1}, {17, 9, 1}, {1, 1, 3}, {64, 65, 3}};

// Light below 0, above 1, tiny and huge, not a number and infinite.
Picture random_light(const Shape& shape, double largest_power) {
  use_modules();
  Picture picture(shape, ValueType::light32, 0);
  Random random(shape.width + shape.channels);
  for (float& value : picture.values<float>()) {
    value =
        static_cast<float>(random.real(-3, 3) * std::pow(10.0, random.real(-largest_power, largest_power)));
  }
  return picture;
}

// Each channel of a file, in the order of a raster.
template <typename Value>
std::vector<Value> read_exr(const std::filesystem::path& path, Imf::PixelType type) {
  Imf::InputFile file(path.c_str());
  const Imath::Box2i window = file.header().dataWindow();
  const auto width = static_cast<std::size_t>(window.max.x + 1),
             height = static_cast<std::size_t>(window.max.y + 1);
  const bool is_grey = file.header().channels().findChannel("Y") != nullptr;
  const std::vector<const char*> names = is_grey ? std::vector{"Y"} : std::vector{"R", "G", "B"};
  std::vector<Value> values(width * height * names.size());
  Imf::FrameBuffer buffer;
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(file.header().channels()[names[i]].type, type);
    buffer.insert(names[i], Imf::Slice(type, reinterpret_cast<char*>(values.data() + i),
                                       names.size() * sizeof(Value), names.size() * sizeof(Value) * width));
  }
  file.setFrameBuffer(buffer);
  file.readPixels(0, window.max.y);
  return values;
}

TEST(OpenExr, HoldsLightToTheLastBit) {
  const Scratch scratch;
  for (const Shape& shape : kShapes) {
    Picture picture = random_light(shape, 20);
    if (shape.pixel_count() > 1) {
      picture.values<float>()[0] = std::nanf("");
      picture.values<float>()[1] = -INFINITY;
    }
    write_picture(scratch / "a.exr", picture);
    const auto read = read_exr<float>(scratch / "a.exr", Imf::FLOAT);
    ASSERT_EQ(read.size(), shape.value_count());
    EXPECT_EQ(std::memcmp(read.data(), picture.bytes.data(), picture.bytes.size()), 0);
  }
}

// A half has 11 bits: rounding moves a value by 2^-11 of itself at most, and below 2^-14 by half of 2^-24.
TEST(OpenExr, HoldsLightInHalvesToTheirPrecision) {
  const Scratch scratch;
  for (const Shape& shape : kShapes) {
    const Picture picture = random_light(shape, 4);
    write_picture(scratch / "a.exr", picture, {}, {.as_half = true});
    const auto read = read_exr<half>(scratch / "a.exr", Imf::HALF);
    for (std::size_t i = 0; i < read.size(); ++i) {
      const double value = picture.values<float>()[i];
      EXPECT_LE(std::fabs(read[i] - value),
                std::max(std::ldexp(std::fabs(value), -11), std::ldexp(1.0, -25)));
    }
  }
  Picture large = random_light({5, 3, 1}, 0);
  large.values<float>()[7] = 65'520;  // the first that rounds beyond the largest, 65504
  expect_error<OutputError>([&] { write_picture(scratch / "b.exr", large, {}, {.as_half = true}); },
                            {"pixel 2,1 has light 65520, and 16-bit floating point ends at 65504"});
  EXPECT_FALSE(std::filesystem::exists(scratch / "b.exr"));
  large.values<float>()[7] = INFINITY;  // light beyond floats is no less beyond halves
  EXPECT_THROW(write_picture(scratch / "b.exr", large, {}, {.as_half = true}), OutputError);
  large.values<float>()[7] = 65'519;
  EXPECT_NO_THROW(write_picture(scratch / "b.exr", large, {}, {.as_half = true}));
}

TEST(OpenExr, SaysWhatItsValuesAre) {
  const Scratch scratch;
  Picture picture = random_light({4, 4, 3}, 0);
  picture.primaries = Primaries::bt2020;
  picture.pixel_aspect = {32, 27};
  picture.exposed_ns = 12'500'000;
  const std::string text = "{\"nutik-cl\":" + std::string(100'000, 'x');
  write_picture(scratch / "a.exr", picture, text);
  const Imf::InputFile file((scratch / "a.exr").c_str());
  const Imf::Header& header = file.header();
  const Imf::Chromaticities& colours = Imf::chromaticities(header);
  // ITU-R BT.2020, table 3.
  EXPECT_EQ(colours.red, Imath::V2f(0.708F, 0.292F));
  EXPECT_EQ(colours.green, Imath::V2f(0.170F, 0.797F));
  EXPECT_EQ(colours.blue, Imath::V2f(0.131F, 0.046F));
  EXPECT_EQ(colours.white, Imath::V2f(0.3127F, 0.3290F));
  EXPECT_EQ(header.pixelAspectRatio(), 32.0F / 27.0F);
  EXPECT_EQ(Imf::expTime(header), 0.0125F);
  EXPECT_EQ(read_picture_text(scratch / "a.exr"), text);

  picture.exposed_ns.reset();
  write_picture(scratch / "b.exr", picture);
  EXPECT_FALSE(Imf::hasExpTime(Imf::InputFile((scratch / "b.exr").c_str()).header()));
  EXPECT_EQ(read_picture_text(scratch / "b.exr"), std::nullopt);
}

// OpenEXR would make room for it.
TEST(Exr, WithAnAttributeLongerThanTheFileIsRefused) {
  use_modules();
  const Scratch scratch;
  write_picture(scratch / "a.exr", Picture({8, 4, 3}, ValueType::light32, 1), "a text");
  std::string bytes = read_file(scratch / "a.exr");
  const std::string attribute("screenWindowWidth\0float\0", 24);
  const std::size_t size = bytes.find(attribute) + attribute.size();
  ASSERT_LT(size, bytes.size());
  bytes.replace(size, 4, "\xff\xff\xff\x7f");
  scratch.write("long.exr", bytes);
  expect_error<InputError>([&] { (void)read_picture_text(scratch / "long.exr"); },
                           {"an attribute of 2147483647 bytes does not fit into its"});
  for (std::size_t count = 8; count < size; ++count) {
    scratch.write("cut.exr", bytes.substr(0, count));
    EXPECT_THROW((void)read_picture_text(scratch / "cut.exr"), InputError) << count;
  }
  // A file of several parts has a header for each; the second one's attribute is too long here.
  const std::string parts("v/1\x01\x02\x10\0\0a\0b\0\0\0\0\0\0c\0d\0\xff\xff\xff\x7f", 8 + 9 + 8);
  scratch.write("parts.exr", parts);
  expect_error<InputError>([&] { (void)read_picture_text(scratch / "parts.exr"); },
                           {"an attribute of 2147483647 bytes does not fit into its 25"});
}

Picture smooth_picture(const Shape& shape) {
  Picture picture(shape, ValueType::code8, 255);
  picture.transfer = Transfer::srgb();
  for (std::size_t i = 0; i < picture.bytes.size(); ++i) {
    const std::size_t pixel = i / shape.channels, x = pixel % shape.width, y = pixel / shape.width;
    const double wave = std::sin(0.09 * static_cast<double>(x) + static_cast<double>(i % shape.channels)) +
                        std::cos(0.07 * static_cast<double>(y));
    picture.values<std::uint8_t>()[i] = static_cast<std::uint8_t>(std::lround(127.5 + 60 * wave));
  }
  return picture;
}

// The largest difference of a code from what OpenCV reads of the file.
int worst_code(const Picture& picture, const std::filesystem::path& path) {
  const cv::Mat read = cv::imread(path.string(), cv::IMREAD_UNCHANGED);
  EXPECT_EQ(read.channels(), static_cast<int>(picture.shape.channels));
  EXPECT_EQ(read.total() * read.elemSize(), picture.bytes.size());
  int worst = 0;
  for (std::size_t i = 0; i < picture.bytes.size(); ++i) {
    const std::size_t bgr = picture.shape.channels == 3 ? i / 3 * 3 + 2 - i % 3 : i;
    worst = std::max(worst, std::abs(static_cast<int>(picture.bytes[i]) - read.data[bgr]));
  }
  return worst;
}

// A clip of what it holds: halves, in its own primaries and pixels.
TEST(OpenExr, IsAClipByWhatItSays) {
  for (const Shape& shape : {Shape{16, 8, 1}, Shape{16, 8, 3}}) {
    const Scratch scratch;
    Picture picture = random_light(shape, 0);
    for (std::uint64_t i = 0; i < shape.value_count(); ++i)
      picture.values<float>()[i] = static_cast<float>(i) / static_cast<float>(shape.value_count());
    picture.primaries = Primaries::bt2020;
    picture.pixel_aspect = {4, 3};
    FileWishes halves;
    halves.as_half = true;
    write_picture(scratch / "a.exr", picture, {}, halves);
    const auto clip = open_test_clip(scratch / "a.exr", {.white_light = 1.0});
    const CaptureFormat& format = clip->info().format;
    EXPECT_EQ(format.shape, shape);
    EXPECT_TRUE(format.transfer.is_linear());
    EXPECT_EQ(format.primaries, shape.channels == 3 ? Primaries::bt2020 : Primaries::bt709);
    EXPECT_NEAR(format.pixel_aspect.value(), 4.0 / 3, 1e-4);
    const auto codes = read_all(*clip).at(0);
    for (std::uint64_t i = 0; i < shape.value_count(); ++i)
      EXPECT_NEAR(code_at(format, codes, i), 65'535.0 * picture.values<float>()[i], 65'535 * 0x1p-12 + 0.5) << i;
  }
}

TEST(OpenExr, OfOtherChannelsOrPixelsIsRefused) {
  const Scratch scratch;
  const auto refusal = [&](std::initializer_list<const char*> channels, const Imath::Box2i& data) {
    const Imath::Box2i shown({0, 0}, {3, 3});
    Imf::Header header(shown, data);
    std::vector<float> values(64, 0.5F);
    Imf::FrameBuffer buffer;
    for (const char* channel : channels) {
      header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
      buffer.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float),
                                        4 * sizeof(float)));
    }
    {
      Imf::OutputFile file((scratch / "a.exr").c_str(), header);
      file.setFrameBuffer(buffer);
      file.writePixels(data.max.y - data.min.y + 1);
    }
    return message_of<InputError>([&] { open_test_clip(scratch / "a.exr"); });
  };
  expect_says(refusal({"BY", "RY", "Y"}, {{0, 0}, {3, 3}}), "its channels are BY, RY and Y; R, G and B, or Y, or");
  expect_says(refusal({"far.G", "far.R"}, {{0, 0}, {3, 3}}), "its channels are far.G and far.R; R, G and B, or Y, or");
  expect_says(refusal({"Y"}, {{0, 0}, {2, 3}}), "its pixels are not those of its picture");
  expect_says(refusal({"Y"}, {{0, 0}, {3, 3}}), "the largest value is 0.5");  // but for its white it is read
}

// At quality 100 each of the 64 coefficients of a block is a whole number, off by a half at most: their orthonormal
// transform moves a code by 64 · 1/2 / 8 = 4 at the very most. Full colour resolution keeps that of smooth colour.
TEST(Jpeg, IsThePictureAsNearAsItsQuality) {
  const Scratch scratch;
  for (const Shape& shape : {Shape{16, 8, 1}, Shape{97, 55, 1}, Shape{97, 55, 3}}) {
    const Picture picture = smooth_picture(shape);
    write_picture(scratch / "100.jpg", picture, {}, {.quality = 100});
    write_picture(scratch / "90.JPG", picture);
    write_picture(scratch / "20.jpeg", picture, {}, {.quality = 20});
    EXPECT_LE(worst_code(picture, scratch / "100.jpg"), shape.channels == 1 ? 4 : 8);
    const auto bytes = [&](const char* name) { return std::filesystem::file_size(scratch / name); };
    EXPECT_LE(bytes("20.jpeg"), bytes("90.JPG"));
    EXPECT_LT(bytes("90.JPG"), bytes("100.jpg"));
  }
}

// A colour that changes from pixel to pixel is lost where colour has half the resolution: red and blue, say, come out
// as the same purple.
TEST(Jpeg, KeepsColourInFullResolution) {
  const Scratch scratch;
  Picture picture({32, 32, 3}, ValueType::code8, 255);
  for (std::size_t i = 0; i < picture.shape.pixel_count(); ++i) {
    picture.bytes[3 * i + (i % 2 == 0 ? 0 : 2)] = std::byte{200};
  }
  write_picture(scratch / "a.jpg", picture, {}, {.quality = 95});
  EXPECT_LE(worst_code(picture, scratch / "a.jpg"), 40);
}

struct ReadJpeg {
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  explicit ReadJpeg(const MappedFile& file) {
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_decompress(&jpeg);
    jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(file.bytes().data()), file.bytes().size());
    jpeg_save_markers(&jpeg, JPEG_APP0 + 2, 0xFFFF);
    jpeg_read_header(&jpeg, TRUE);
  }
  ~ReadJpeg() { jpeg_destroy_decompress(&jpeg); }
};

TEST(Jpeg, SaysWhatItsCodesAre) {
  const Scratch scratch;
  for (const std::uint32_t channels : {1u, 3u}) {
    Picture picture = smooth_picture({20, 10, channels});
    picture.pixel_aspect = {32, 27};
    // More than a segment holds.
    const std::string text = "{\"nutik-cl\":" + std::string(150'000, 'x') + "}";
    write_picture(scratch / "a.jpg", picture, text);
    EXPECT_EQ(read_picture_text(scratch / "a.jpg"), text);
    const MappedFile file(scratch / "a.jpg");
    ReadJpeg read(file);
    EXPECT_EQ(read.jpeg.density_unit, 0);
    EXPECT_EQ(read.jpeg.X_density, 27);
    EXPECT_EQ(read.jpeg.Y_density, 32);
    JOCTET* bytes = nullptr;
    unsigned size = 0;
    ASSERT_TRUE(jpeg_read_icc_profile(&read.jpeg, &bytes, &size));
    const cmsHPROFILE profile = cmsOpenProfileFromMem(bytes, size);
    std::free(bytes);
    ASSERT_NE(profile, nullptr);
    EXPECT_EQ(cmsGetColorSpace(profile), channels == 1 ? cmsSigGrayData : cmsSigRgbData);
    // Mid-grey of IEC 61966-2-1: ((0.5 + 0.055) / 1.055)^2.4.
    const auto* curve = static_cast<const cmsToneCurve*>(
        cmsReadTag(profile, channels == 1 ? cmsSigGrayTRCTag : cmsSigGreenTRCTag));
    ASSERT_NE(curve, nullptr);
    EXPECT_NEAR(cmsEvalToneCurveFloat(curve, 0.5F), 0.21404, 1e-4);
    cmsCloseProfile(profile);
  }
  Picture plain = smooth_picture({20, 10, 3});
  plain.pixel_aspect = {200'003, 100'001};  // more than 16 bits
  write_picture(scratch / "b.jpg", plain);
  const MappedFile file(scratch / "b.jpg");
  ReadJpeg read(file);
  EXPECT_NEAR(static_cast<double>(read.jpeg.Y_density) / read.jpeg.X_density, 200'003.0 / 100'001, 1e-4);
  EXPECT_EQ(read_picture_text(scratch / "b.jpg"), std::nullopt);
}

TEST(PictureWriter, SaysWhichFilesHoldWhatWasAskedFor) {
  const auto type = [](const char* name, std::optional<Depth> wish) {
    return value_type_for(name, wish, ValueType::code16, 3);
  };
  EXPECT_EQ(type("a.jpg", {}), ValueType::code8);
  EXPECT_EQ(type("a.exr", {}), ValueType::light32);
  EXPECT_EQ(type("a.exr", Depth::half), ValueType::light32);
  const auto refusal = [&](const char* name, Depth wish) {
    return message_of<UsageError>([&] { return type(name, wish); });
  };
  EXPECT_EQ(refusal("a.jpg", Depth::bits16), "a.jpg holds 8 bits only; write a .png, .tif, .ppm or .pgm");
  EXPECT_EQ(refusal("a.jpg", Depth::floating),
            "a.jpg cannot hold floating point; write a .tif, .exr, .pfm or .npy");
  EXPECT_EQ(type("a.npy", {}), ValueType::light32);
  EXPECT_EQ(type("a.tif", Depth::doubled), ValueType::light64);
  EXPECT_EQ(refusal("a.exr", Depth::doubled), "a.exr holds no floating point of 64 bits; write a .tif or .npy");
  EXPECT_EQ(refusal("a.tif", Depth::half), "a.tif holds floating point of 32 bits, not of 16; write a .exr");
  EXPECT_EQ(refusal("a.exr", Depth::bits8), "a.exr holds floating point only; write a .png, .tif or .ppm");
  const Scratch scratch;
  EXPECT_THROW(write_picture(scratch / "a.exr", smooth_picture({4, 4, 1})), UsageError);
  EXPECT_THROW(write_picture(scratch / "a.png", random_light({4, 4, 1}, 0)), UsageError);
  const Picture wide(Shape{65'501, 1, 1}, ValueType::code8, 255);
  expect_error<UsageError>([&] { write_picture(scratch / "wide.jpg", wide); }, {"65500 x 65500"});
  EXPECT_TRUE(std::filesystem::is_empty(scratch.folder()));
}

}  // namespace
}  // namespace nutik::test
