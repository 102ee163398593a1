// Floating-point pictures as clips: what is written comes back, to the nearest of 65535 steps of the white that was
// stated; what a capture cannot hold is refused by its pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "capture/error.hpp"
#include "media/formats/input_kinds.hpp"
#include "media/stills/tiff_reader.hpp"
#include "media/writers/picture_writer.hpp"
#include "support/clips.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

constexpr Shape kGrey{17, 9, 1}, kColour{13, 21, 3};
constexpr double kWhite = 2.5;

template <typename Value>
Picture random_light(const Shape& shape, ValueType type, std::uint64_t seed) {
  Picture picture(shape, type, 0);
  Random random(seed);
  for (Value& value : picture.values<Value>()) value = static_cast<Value>(random.real(0, kWhite));
  picture.values<Value>()[0] = 0;
  picture.values<Value>()[1] = static_cast<Value>(kWhite);
  return picture;
}

template <typename Value>
void expect_comes_back(const std::string& extension, ValueType type) {
  for (const Shape& shape : {kGrey, kColour}) {
    SCOPED_TRACE(extension + (shape.channels == 1 ? ", grey" : ", colour"));
    const Scratch scratch;
    use_modules();
    std::vector<Picture> written;
    for (std::uint64_t k = 0; k < 3; ++k) {
      written.push_back(random_light<Value>(shape, type, k + 1));
      write_picture(scratch / ("f" + std::to_string(k) + extension), written.back());
    }
    const auto clip = open_test_clip(scratch.folder(), {.white_light = kWhite});
    EXPECT_EQ(clip->info().format.shape, shape);
    EXPECT_EQ(clip->info().format.white_code, 65'535u);
    EXPECT_EQ(clip->info().format.transfer, Transfer::linear());
    EXPECT_EQ(clip->info().roundings, CodeRoundings{0.5});
    EXPECT_EQ(facts_of(*clip).at(Setting::white_code).line(),
              "light 2.5 is white, to the nearest of 65535 steps, as stated");
    const auto rasters = read_all(*clip);
    ASSERT_EQ(rasters.size(), written.size());
    for (std::size_t k = 0; k < rasters.size(); ++k) {
      const auto* codes = reinterpret_cast<const std::uint16_t*>(rasters[k].data());
      const auto light = written[k].values<Value>();
      for (std::size_t i = 0; i < light.size(); ++i)
        ASSERT_LE(std::abs(codes[i] - double{light[i]} / kWhite * 65'535), 0.5) << "value " << i << " of picture " << k;
    }
    const ClipOptions curved{.transfer = Transfer::srgb(), .white_light = kWhite};
    const auto raster = read_all(*open_test_clip(scratch.folder(), curved)).front();
    const auto light = written[0].values<Value>();
    for (std::size_t i = 0; i < light.size(); ++i)
      ASSERT_NEAR(reinterpret_cast<const std::uint16_t*>(raster.data())[i],
                  curved.transfer->fraction_of(light[i] / kWhite) * 65'535, 0.5001);
  }
}

TEST(LightClip, EveryKindThatIsWrittenComesBack) {
  for (const char* extension : {".tif", ".exr", ".pfm", ".npy"})
    expect_comes_back<float>(extension, ValueType::light32);
  for (const char* extension : {".tif", ".npy"}) expect_comes_back<double>(extension, ValueType::light64);
}

TEST(LightClip, OfPrimariesThatAreNotKnownIsNamed) {
  const Scratch scratch;
  use_modules();
  Picture light = random_light<float>(kColour, ValueType::light32, 5);
  light.primaries = Primaries::bt2020;
  write_picture(scratch / "a.exr", light);
  std::string exr = read_file(scratch / "a.exr");
  const std::size_t place = exr.rfind("chromaticities") + 15 + 4;
  const float red = 0.69F;
  std::memcpy(exr.data() + place, &red, sizeof red);
  scratch.write("b.exr", exr);
  const auto line = [&](const char* name) {
    return facts_of(*open_test_clip(scratch / name, {.white_light = kWhite})).at(Setting::primaries).line();
  };
  EXPECT_EQ(line("a.exr"), "primaries bt2020, from the file");
  const std::string at = "red at 0.69 0.292, green at 0.17 0.797, blue at 0.131 0.046, white at 0.3127 0.329";
  EXPECT_EQ(line("b.exr"), "primaries bt709, assumed; the file names " + at);
  const auto notes = open_test_clip(scratch / "b.exr", {.white_light = kWhite})->info().notes;
  ASSERT_EQ(notes.size(), 1u);
  expect_says(notes[0].text, "the file's primaries, " + at + ", are none that are known here");
  EXPECT_EQ(notes[0].settings, std::vector{Setting::primaries});
  const ClipOptions stated{.primaries = Primaries::p3, .white_light = kWhite};
  EXPECT_TRUE(open_test_clip(scratch / "b.exr", stated)->info().notes.empty());
}

TEST(LightClip, DoublesAreWrittenToTheLastBit) {
  const Scratch scratch;
  const Picture light = random_light<double>(kColour, ValueType::light64, 5);
  write_picture(scratch / "a.npy", light);
  write_picture(scratch / "a.tif", light);
  EXPECT_EQ(TiffReader(scratch / "a.tif").next()->picture.bytes, light.bytes);
  const std::string bytes = read_file(scratch / "a.npy");
  EXPECT_EQ(bytes.substr(0, 10), std::string("\x93NUMPY\1\0\x76\0", 10)) << "128 bytes in front, 118 of them text";
  expect_says(bytes, "{'descr': '<f8', 'fortran_order': False, 'shape': (21, 13, 3), }");
  EXPECT_EQ(bytes.size(), 128 + light.bytes.size());
  EXPECT_EQ(inputs::kNumpy.read(std::as_bytes(std::span(bytes)), "a.npy", 0).picture.bytes, light.bytes);
  expect_error<UsageError>([&] { write_picture(scratch / "a.exr", light); }, {"cannot hold the values"});
}

std::string npy(const std::string& words, const std::string& values) {
  std::string text("\x93NUMPY\2\0", 8);
  for (std::size_t i = 0; i < 4; ++i) text.push_back(static_cast<char>(words.size() >> (8 * i)));
  return text + words + values;
}

TEST(LightClip, ArraysHaveTheirPicturesBehindOneAnother) {
  const Scratch scratch;
  scratch.write("a.npy",
                npy("{'shape': (2, 2, 6), 'fortran_order': False, 'descr': '|u1'}\n", "abcdefghijklmnopqrstuvwx"));
  const auto clip = open_test_clip(scratch / "a.npy");
  EXPECT_EQ(clip->info().format.shape, (Shape{6, 2, 1}));
  EXPECT_EQ(clip->info().format.transfer, Transfer::srgb());
  const auto rasters = read_all(*clip);
  ASSERT_EQ(rasters.size(), 2u);
  EXPECT_EQ(std::memcmp(rasters[1].data(), "mnopqrstuvwx", 12), 0);
  // A last axis of 1 is that of grey.
  scratch.write("grey.npy",
                npy("{'shape': (2, 3, 1), 'fortran_order': False, 'descr': '|u1'}\n", "abcdef"));
  const auto grey = open_test_clip(scratch / "grey.npy");
  EXPECT_EQ(grey->info().format.shape, (Shape{3, 2, 1}));
  EXPECT_EQ(read_all(*grey).size(), 1u);
}

TEST(LightClip, OtherArraysAreRefusedByWhatTheyAre) {
  const Scratch scratch;
  const auto refused = [&](const std::string& words, const std::string& part) {
    scratch.write("a.npy", npy(words, std::string(64, '\0')));
    expect_error<InputError>([&] { open_test_clip(scratch / "a.npy", {.white_light = 1.0}); }, {part});
  };
  refused("{'descr': '>f4', 'fortran_order': False, 'shape': (2, 2)}", "its values are '>f4'; uint8, uint16, float32");
  refused("{'descr': '<i4', 'fortran_order': False, 'shape': (2, 2)}", "its values are '<i4'");
  refused("{'descr': '<f4', 'fortran_order': True, 'shape': (2, 2)}", "numpy.ascontiguousarray");
  refused("{'descr': '<f4', 'fortran_order': False, 'shape': (4,)}", "its axes are none of [height, width]");
  refused("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 0)}", "it states 1 pictures of 0 x 2 pixels");
  refused("{'descr': '<f4', 'fortran_order': False, 'shape': (5, 4)}", "it was cut off");
  refused("{'descr': '<f4', 'fortran_order': False, 'shape': (18446744073709551615, 2, 5)}", "it was cut off");
  refused("{'descr': '|u1', 'fortran_order': False, 'shape': (4, 4, 4)}", "numpy.save(file, array[..., :3])");
  refused("{'descr': '|u1', 'fortran_order': False, 'shape': (4, 8, 2)}", "numpy.save(file, array[..., 0])");
  refused("{'fortran_order': False, 'shape': (5, 4)}", "does not say its descr");
  refused("{'descr': '|u1', 'fortran_order': False, 'shape': (2, 4)}", "it goes on behind its array, by 56 bytes");
}

TEST(LightClip, ValuesThatNoCaptureHoldsAreRefusedByTheirPixel) {
  const Scratch scratch;
  const auto refused = [&](double value, std::optional<double> white, const std::string& part) {
    Picture light(kGrey, ValueType::light64, 0);
    light.values<double>()[17 * 3 + 5] = value;
    write_picture(scratch / "a.npy", light);
    expect_error<InputError>([&] { open_test_clip(scratch / "a.npy", {.white_light = white}); }, {part});
  };
  refused(0.75, std::nullopt, "how much of it is white; the largest value is 0.75: state the light of white");
  refused(1.5, 1.0, "pixel 5,3 has light 1.5, and a capture holds what lies between 0 and white, 1; state a larger");
  refused(-0.25, 1.0, "pixel 5,3 has light -0.25, and a capture holds what lies between 0 and white, 1; "
                      "add as much to all of its light as the darkest lacks");
  refused(std::nan(""), 1.0, "pixel 5,3 has light nan");
  refused(std::numeric_limits<double>::infinity(), 1.0, "pixel 5,3 has light inf");
}

TEST(LightClip, PfmComesInEitherOrderOfBytes) {
  const Scratch scratch;
  std::string values;
  for (const float value : {0.25F, 0.5F, 0.75F, 1.0F}) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    std::reverse(bytes, bytes + sizeof value);
    values.append(bytes, sizeof value);
  }
  scratch.write("a.pfm", "Pf\n2 2\n1.0\n" + values);
  const auto rasters = read_all(*open_test_clip(scratch / "a.pfm", {.white_light = 1.0}));
  const std::uint16_t expected[] = {49'151, 65'535, 16'384, 32'768};  // the lowest row first
  EXPECT_EQ(std::memcmp(rasters.at(0).data(), expected, sizeof expected), 0);
  for (const char* broken : {"Pf\n2 2\n0\n", "Pf\n2 2\n", "Pf\n2 2\n-1\nabc", "Pf\n0 2\n-1\n", "Pf\n1 1\n-1\nabcde"}) {
    scratch.write("b.pfm", broken);
    expect_error<InputError>([&] { open_test_clip(scratch / "b.pfm", {.white_light = 1.0}); },
                             {"b.pfm cannot be read"});
  }
}

TEST(LightClip, PicturesOfCodesAndOfLightAreNoSequence) {
  const Scratch scratch;
  use_modules();
  write_picture(scratch / "f0.tif", random_light<float>(kGrey, ValueType::light32, 1));
  write_picture(scratch / "f1.tif", Picture(kGrey, ValueType::code16, 65'535));
  const auto clip = open_test_clip(scratch.folder(), {.white_light = kWhite});
  expect_error<InputError>([&] { read_all(*clip); }, {"All must be alike"});
}

}  // namespace
}  // namespace nutik::test
