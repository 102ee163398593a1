// What ICC profiles in stills say is believed, and named where it is not known.
#include <gtest/gtest.h>
#include <lcms2.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <opencv2/imgcodecs.hpp>

#include "capture/error.hpp"
#include "media/formats/colour_profile.hpp"
#include "media/writers/picture_writer.hpp"
#include "support/clips.hpp"
#include "support/comma_locale.hpp"
#include "support/messages.hpp"
#include "support/scratch.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

// Whatever this program writes, it reads as what it is.
TEST(ColourProfile, OfWhatIsWrittenHereIsBelieved) {
  const Scratch scratch;
  const std::array transfers{Transfer::srgb(),     Transfer::linear(),    Transfer::bt709(),
                             Transfer::hlg(),      Transfer::pq(),        Transfer::gamma(1),
                             Transfer::gamma(1.8), Transfer::gamma(2.2),  Transfer::gamma(2.35),
                             Transfer::gamma(2.6), Transfer::gamma(4.125)};
  for (const char* name : {"still.png", "still.tif", "still.jpg"}) {
    for (const std::uint32_t channels : {1u, 3u}) {
      for (const bool is_deep : {false, true}) {
        if (is_deep && is_lossy_name(name)) continue;
        for (const Primaries primaries : all_primaries()) {
          for (const Transfer& transfer : transfers) {
            Picture picture = random_stills({16, 16, channels}, is_deep ? 65'535 : 255, 1, channels).front();
            picture.transfer = transfer;
            picture.primaries = primaries;
            write_picture(scratch / name, picture);
            const auto clip = open_test_clip(scratch / name);
            SCOPED_TRACE(testing::Message() << name << ", " << channels << " channels, " << transfer.text()
                                            << ", " << to_text(primaries));
            const Transfer expected = transfer == Transfer::gamma(1) ? Transfer::linear() : transfer;
            EXPECT_EQ(clip->info().format.transfer.text(), expected.text());
            auto facts = facts_of(*clip);
            EXPECT_EQ(facts.at(Setting::transfer).origin, Origin::file);
            if (channels == 3) {
              EXPECT_EQ(clip->info().format.primaries, primaries);
              EXPECT_EQ(facts.at(Setting::primaries).origin, Origin::file);
            }
          }
        }
      }
    }
  }
}

TEST(ColourProfile, IsTheSameWhereNumbersHaveAComma) {
  Picture picture({1, 1, 3}, ValueType::code8, 255);
  picture.transfer = Transfer::gamma(2.6);
  const auto usual = colour_profile(picture);
  const CommaLocale locale;
  if (!locale.is_set()) GTEST_SKIP() << "localedef makes no locale with a decimal comma here";
  EXPECT_EQ(colour_profile(picture), usual);
}

// White is that of the profile's own space, or absolute intents tint grey; and both say what it was adapted from.
TEST(ColourProfile, OfGreyHasTheWhiteOfColour) {
  Picture picture({1, 1, 3}, ValueType::code8, 255);
  picture.transfer = Transfer::srgb();
  std::string tags[2];
  for (const std::uint32_t channels : {1u, 3u}) {
    picture.shape.channels = channels;
    const auto bytes = colour_profile(picture);
    const auto profile = cmsOpenProfileFromMem(bytes.data(), static_cast<cmsUInt32Number>(bytes.size()));
    for (const auto tag : {cmsSigMediaWhitePointTag, cmsSigChromaticAdaptationTag}) {
      std::string& value = tags[channels / 2] += std::string(44, '\0');
      EXPECT_GT(cmsReadRawTag(profile, tag, &value[value.size() - 44], 44), 0u);
    }
    cmsCloseProfile(profile);
  }
  EXPECT_EQ(tags[0], tags[1]);
}

using Curve = std::unique_ptr<cmsToneCurve, decltype(&cmsFreeToneCurve)>;

Curve table_of(std::uint32_t entries, double (*light_of)(double)) {
  std::vector<cmsUInt16Number> table(entries);
  for (std::uint32_t i = 0; i < entries; ++i) {
    table[i] = static_cast<cmsUInt16Number>(std::lround(65'535 * light_of(double{1} * i / (entries - 1))));
  }
  return {cmsBuildTabulatedToneCurve16(nullptr, entries, table.data()), &cmsFreeToneCurve};
}

double srgb_light(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

std::string profile_bytes(cmsHPROFILE profile, const char* name) {
  cmsMLU* text = cmsMLUalloc(nullptr, 1);
  cmsMLUsetASCII(text, "en", "US", name);
  cmsWriteTag(profile, cmsSigProfileDescriptionTag, text);
  cmsMLUfree(text);
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile, nullptr, &size);
  std::string bytes(size, '\0');
  cmsSaveProfileToMem(profile, bytes.data(), &size);
  cmsCloseProfile(profile);
  return bytes;
}

std::string rgb_profile(const char* name, cmsToneCurve* curve, const cmsCIExyYTRIPLE& primaries) {
  const cmsCIExyY white{0.3127, 0.3290, 1};
  cmsToneCurve* curves[]{curve, curve, curve};
  return profile_bytes(cmsCreateRGBProfile(&white, &primaries, curves), name);
}

constexpr cmsCIExyYTRIPLE kSrgb{{0.64, 0.33, 1}, {0.30, 0.60, 1}, {0.15, 0.06, 1}};
constexpr cmsCIExyYTRIPLE kAdobe{{0.64, 0.33, 1}, {0.21, 0.71, 1}, {0.15, 0.06, 1}};
constexpr cmsCIExyYTRIPLE kOther{{0.65, 0.32, 1}, {0.20, 0.70, 1}, {0.14, 0.05, 1}};

// A JPEG of another program's: the profile in segments APP2 behind the first, as ICC.1 says.
void write_jpeg_with(const std::filesystem::path& path, const std::string& profile,
                     std::size_t part_bytes = 60'000) {
  ASSERT_TRUE(cv::imwrite(path.string(), cv::Mat(16, 16, CV_8UC3, cv::Scalar(40, 80, 160))));
  std::string jpeg = read_file(path);
  const std::size_t parts = (profile.size() + part_bytes - 1) / part_bytes;
  std::string segments;
  for (std::size_t i = 0; i < parts; ++i) {
    const std::string part = profile.substr(i * part_bytes, part_bytes);
    const std::size_t length = 2 + 12 + 2 + part.size();
    segments += std::string("\xFF\xE2") + static_cast<char>(length >> 8) + static_cast<char>(length & 255);
    segments += std::string("ICC_PROFILE\0", 12) + static_cast<char>(i + 1) + static_cast<char>(parts) + part;
  }
  jpeg.insert(2 + 2 + 16, segments);  // behind its start and the JFIF header
  std::ofstream(path, std::ios::binary) << jpeg;
}

// As image editors write it: by parameters, or in tables of 1024 entries, in one segment or several.
TEST(ColourProfile, OfSrgbByOtherProgramsIsBelieved) {
  const Scratch scratch;
  const Curve table = table_of(1024, srgb_light);
  const std::map<std::string, std::string> profiles{
      {"GIMP built-in sRGB", profile_bytes(cmsCreate_sRGBProfile(), "GIMP built-in sRGB")},
      {"sRGB IEC61966-2.1", rgb_profile("sRGB IEC61966-2.1", table.get(), kSrgb)}};
  for (const auto& [name, profile] : profiles) {
    for (const std::size_t part_bytes : {60'000, 500}) {
      write_jpeg_with(scratch / "still.jpg", profile, part_bytes);
      const auto clip = open_test_clip(scratch / "still.jpg");
      EXPECT_EQ(clip->info().notes.size(), 0u);
      auto facts = facts_of(*clip);
      EXPECT_EQ(facts.at(Setting::transfer).line(), "transfer srgb, from the ICC profile '" + name + "'");
      EXPECT_EQ(facts.at(Setting::primaries).line(), "primaries bt709, from the ICC profile '" + name + "'");
    }
  }
}

// A curve that is known is believed, beside primaries that are not.
TEST(ColourProfile, OfPrimariesThatAreNotKnownIsNamed) {
  const Scratch scratch;
  const Curve curve(cmsBuildGamma(nullptr, 563.0 / 256), &cmsFreeToneCurve);
  write_jpeg_with(scratch / "still.jpg", rgb_profile("Adobe RGB (1998)", curve.get(), kAdobe));
  EXPECT_EQ(facts_of(*open_test_clip(scratch / "still.jpg")).at(Setting::primaries).line(),
            "primaries adobe-rgb, from the ICC profile 'Adobe RGB (1998)'");
  write_jpeg_with(scratch / "still.jpg", rgb_profile("Camera RGB", curve.get(), kOther));
  const auto clip = open_test_clip(scratch / "still.jpg");
  auto facts = facts_of(*clip);
  EXPECT_EQ(facts.at(Setting::transfer).origin, Origin::file);
  EXPECT_NEAR(std::stod(clip->info().format.transfer.text().substr(6)), 563.0 / 256, 1e-5);
  EXPECT_EQ(facts.at(Setting::primaries).line(),
            "primaries bt709, assumed; the file names the ICC profile 'Camera RGB'");
  ASSERT_EQ(clip->info().notes.size(), 1u);
  expect_says(clip->info().notes[0].text, "'Camera RGB' says what the codes stand for, and its primaries are none");
  expect_says(clip->info().notes[0].text, "magick IN -profile sRGB.icc OUT makes pictures of known ones; or state");
  EXPECT_EQ(clip->info().notes[0].settings, std::vector{Setting::primaries});
  EXPECT_TRUE(open_test_clip(scratch / "still.jpg", {.primaries = Primaries::p3})->info().notes.empty());
}

TEST(ColourProfile, OfACurveThatIsNotKnownIsNamed) {
  const Scratch scratch;
  const Curve curve = table_of(256, [](double code) { return 0.5 * code + 0.5 * code * code * code; });
  write_jpeg_with(scratch / "still.jpg", rgb_profile("a\x1b[31m scanner", curve.get(), kSrgb));
  const auto clip = open_test_clip(scratch / "still.jpg");
  EXPECT_EQ(facts_of(*clip).at(Setting::transfer).line(),
            "transfer srgb, assumed; the file names the ICC profile 'a[31m scanner'");
  EXPECT_EQ(clip->info().format.primaries, Primaries::bt709);
  ASSERT_EQ(clip->info().notes.size(), 1u);
  EXPECT_EQ(clip->info().notes[0].settings, std::vector{Setting::transfer});
}

TEST(ColourProfile, ThatIsDamagedIsNamed) {
  const Scratch scratch;
  std::string profile = profile_bytes(cmsCreate_sRGBProfile(), "sRGB");
  profile.resize(200);
  write_jpeg_with(scratch / "still.jpg", profile);
  const auto clip = open_test_clip(scratch / "still.jpg");
  ASSERT_EQ(clip->info().notes.size(), 1u);
  expect_says(clip->info().notes[0].text, "a damaged ICC profile");
  EXPECT_EQ(facts_of(*clip).at(Setting::transfer).origin, Origin::assumed);
}

// Stills of one clip stand for light in one way.
TEST(ColourProfile, OfOneStillIsThatOfAll) {
  const Scratch scratch;
  const Curve linear(cmsBuildGamma(nullptr, 1), &cmsFreeToneCurve);
  write_jpeg_with(scratch / "1.jpg", profile_bytes(cmsCreate_sRGBProfile(), "sRGB"));
  write_jpeg_with(scratch / "2.jpg", rgb_profile("linear", linear.get(), kSrgb));
  const auto clip = open_test_clip(scratch.folder());
  const auto error = error_of<InputError>([&] { read_all(*clip); });
  ASSERT_TRUE(error) << "both were read";
  EXPECT_NE(std::string(error->what()).find("2.jpg has transfer linear"), std::string::npos) << error->what();
  EXPECT_EQ(error->settings(), std::vector{Setting::transfer});
  EXPECT_EQ(read_all(*open_test_clip(scratch.folder(), {.transfer = Transfer::srgb()})).size(), 2u);
  // What is not known is not what is usual.
  const Curve other(cmsBuildParametricToneCurve(nullptr, 4, std::array{1.8, 0.9, 0.1, 0.08, 0.05}.data()),
                    &cmsFreeToneCurve);
  write_jpeg_with(scratch / "2.jpg", rgb_profile("other", other.get(), kSrgb));
  expect_error<InputError>(
      [&] { read_all(*open_test_clip(scratch.folder())); },
      {"2.jpg has transfer the ICC profile 'other' and primaries bt709, the first still, ", "srgb and bt709"});
}

}  // namespace
}  // namespace nutik::test
