// Channels of stills beside grey or colour are left out, with a note; where codes count as they stand they are refused.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <gtest/gtest.h>

#include <cstring>
#include <tuple>

#include "capture/error.hpp"
#include "media/stills/mask_reader.hpp"
#include "media/writers/picture_writer.hpp"
#include "support/clips.hpp"
#include "support/hostile.hpp"
#include "support/messages.hpp"
#include "support/scratch.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

constexpr Shape kLeftGrey{17, 9, 1}, kLeftColour{17, 9, 3};
constexpr const char* kClear = "the file's transparency is left out";

// With one more channel, of other codes.
Picture with_channel(const Picture& still) {
  Shape shape = still.shape;
  ++shape.channels;
  Picture more = random_stills(shape, still.white_code, 1, 99)[0];
  const std::size_t value = value_bytes(still.type), pixel = value * still.shape.channels;
  for (std::uint64_t i = 0; i < shape.pixel_count(); ++i)
    std::memcpy(more.bytes.data() + i * (pixel + value), still.bytes.data() + i * pixel, pixel);
  return more;
}

void expect_noted(Clip& clip, const std::string& note, const std::vector<Picture>& stills) {
  ASSERT_EQ(clip.info().notes.size(), 1u);
  EXPECT_EQ(clip.info().notes[0].text, note);
  expect_codes(clip, stills);
  EXPECT_TRUE(clip.remarks().empty());
}

TEST(LeftOut, OfTiffIsWhatIsBesideColourOrClear) {
  const Scratch scratch;
  const auto write = [&](const std::vector<Picture>& stills, int bits, bool planar, int extra) {
    TiffOptions options{bits, false, false, planar};
    options.extra = extra;
    std::vector<Picture> more;
    for (const Picture& still : stills) more.push_back(with_channel(still));
    return scratch.write("a.tif", tiff_file(more, options));
  };
  for (const bool planar : {false, true}) {
    for (const auto& [shape, bits, extra, note] : {std::tuple(kLeftColour, 8, 1, kClear),
                                                   {kLeftColour, 12, 2, kClear},
                                                   {kLeftColour, 16, 0, "the file's channel 4 is left out"},
                                                   {kLeftColour, 16, -1, "the file's channel 4 is left out"},
                                                   {kLeftGrey, 12, 2, kClear}}) {
      SCOPED_TRACE(testing::Message() << bits << " bits, " << extra << (planar ? ", planar" : ""));
      const auto stills = random_stills(shape, (1u << bits) - 1, 2, 7);
      const auto clip = open_test_clip(write(stills, bits, planar, extra), {.white_code = (1u << bits) - 1});
      expect_noted(*clip, note, stills);
    }
  }
  for (const int extra : {0, -1}) {
    expect_error<InputError>([&] { open_test_clip(write(random_stills(kLeftGrey, 255, 1, 7), 8, false, extra)); },
                             {"its 2 samples a pixel are channels of grey, not colour"});
  }
}

TEST(LeftOut, OfPngIsTransparency) {
  const Scratch scratch;
  for (const auto& [shape, white, clear] : {std::tuple(kLeftGrey, 255u, std::string(1, '\0') + '\7'),
                                            {kLeftGrey, 65'535u, std::string("\1\7")},
                                            {kLeftColour, 255u, std::string("\0\7\0\7\0\7", 6)}}) {
    const auto stills = random_stills(shape, white, 1, 5);
    write_picture(scratch / "a.png", stills[0]);
    scratch.write("clear.png", with_chunk(read_file(scratch / "a.png"), "tRNS", clear));
    expect_noted(*open_test_clip(scratch / "clear.png", {.white_code = white}), kClear, stills);
  }
}

std::string pam(const Picture& still, const std::string& type) {
  std::string file = "P7\nWIDTH 17\nHEIGHT 9\nDEPTH " + std::to_string(still.shape.channels) + "\nMAXVAL " +
                     std::to_string(still.white_code) + "\nTUPLTYPE " + type + "\nENDHDR\n";
  for (std::uint64_t i = 0; i < still.shape.value_count(); ++i) {
    if (still.white_code > 255) file += static_cast<char>(test::code_of(still, i) >> 8);
    file += static_cast<char>(test::code_of(still, i) & 0xFF);
  }
  return file;
}

// Four channels may be inks.
TEST(LeftOut, OfPamIsWhatItNamesSo) {
  const Scratch scratch;
  for (const std::uint32_t white : {255u, 4095u}) {
    for (const auto& [shape, type] : {std::pair(kLeftGrey, "GRAYSCALE_ALPHA"), {kLeftColour, "RGB_ALPHA"}}) {
      const auto stills = random_stills(shape, white, 2, white);
      const auto files = pam(with_channel(stills[0]), type) + pam(with_channel(stills[1]), type);
      expect_noted(*open_test_clip(scratch.write("a.pam", files)), kClear, stills);
      scratch.write("mask.pam", pam(with_channel(stills[0]), type));
      expect_error<InputError>([&] { return read_mask(scratch / "mask.pam"); },
                               {"mask.pam has transparency beside its codes; save it without"});
    }
  }
  scratch.write("inks.pam", pam(with_channel(random_stills(kLeftColour, 255, 1, 1)[0]), "CMYK"));
  expect_error<InputError>([&] { open_test_clip(scratch / "inks.pam"); },
                           {"inks.pam cannot be read: it has 4 channels; grey (1) and colour (3) are read"});
}

TEST(LeftOut, OfLaterStillsIsSaidWhenTheyWereRead) {
  const Scratch scratch;
  const auto stills = random_stills(kLeftColour, 255, 3, 5);
  for (std::size_t k = 0; k < stills.size(); ++k)
    scratch.write("f" + std::to_string(k) + ".pam",
                  k == 0 ? pam(stills[k], "RGB") : pam(with_channel(stills[k]), "RGB_ALPHA"));
  const auto clip = open_test_clip(scratch.folder());
  EXPECT_TRUE(clip->info().notes.empty());
  expect_codes(*clip, stills);
  ASSERT_EQ(clip->remarks().size(), 1u);
  EXPECT_EQ(clip->remarks()[0].text, (scratch / "f1.pam").string() + ": " + kClear);
}

// Red, green and blue, else Y, else the only one.
TEST(LeftOut, OfOpenExrIsNamed) {
  const Scratch scratch;
  use_modules();
  const std::size_t pixels = 12;
  const auto write = [&](std::vector<std::string> names) {
    Imf::Header header(4, 3);
    Imf::FrameBuffer buffer;
    std::vector<std::vector<float>> planes;
    for (std::size_t i = 0; i < names.size(); ++i)
      planes.emplace_back(pixels, static_cast<float>(names[i][0]) / 128);
    for (std::size_t i = 0; i < names.size(); ++i) {
      header.channels().insert(names[i], Imf::Channel(Imf::FLOAT));
      auto* first = reinterpret_cast<char*>(planes[i].data());
      buffer.insert(names[i], Imf::Slice(Imf::FLOAT, first, sizeof(float), 4 * sizeof(float)));
    }
    {
      Imf::OutputFile file((scratch / "a.exr").c_str(), header, 1);
      file.setFrameBuffer(buffer);
      file.writePixels(3);
    }
    return open_test_clip(scratch / "a.exr", {.white_light = 1.0});
  };
  for (const auto& [names, taken, left] :
       std::vector<std::tuple<std::vector<std::string>, std::string, std::string>>{
           {{"R", "G", "B", "A"}, "RGB", "channel A is"},
           {{"R", "G", "B", "Z"}, "RGB", "channel Z is"},
           {{"R", "G", "B", "A", "Z", "far.R"}, "RGB", "channels A, Z and far.R are"},
           {{"A", "Y", "Z"}, "Y", "channels A and Z are"},
           {{"A", "L"}, "L", "channel A is"}}) {
    const auto clip = write(names);
    ASSERT_EQ(clip->info().notes.size(), 1u);
    EXPECT_EQ(clip->info().notes[0].text, "the file's " + left + " left out");
    const auto raster = read_all(*clip).front();
    ASSERT_EQ(raster.size(), pixels * taken.size() * 2);
    for (std::size_t i = 0; i < pixels * taken.size(); ++i) {
      const double light = static_cast<double>(taken[i % taken.size()]) / 128;
      EXPECT_NEAR(reinterpret_cast<const std::uint16_t*>(raster.data())[i], light * 65'535, 0.5);
    }
  }
}

}  // namespace
}  // namespace nutik::test
