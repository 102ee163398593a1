// Clips whose camera changed its exposure: against the same scene as its first picture shows it.
#include "media/deflicker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "capture/format.hpp"
#include "support/clips.hpp"
#include "support/messages.hpp"
#include "support/scratch.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

constexpr Shape kShape{160, 96, 3};
constexpr std::uint32_t kSamples = 8;

// What a camera makes of light: brighter and dimmer by up to a half, each colour by its own, through a curve that
// bends more where there is more light.
double code_of(double light, std::uint32_t sample, std::uint32_t channel) {
  const double gain = 1 + 0.5 * std::sin(0.9 * sample + 0.15 * channel * sample);
  const double exposed = gain * light;
  return std::pow(1.25 * exposed / (1 + 0.25 * exposed), 1 / 2.2);
}

// A scene of all brightnesses, with fine detail; a dark subject, a fifth of the picture, crosses it.
double light_at(std::uint32_t x, std::uint32_t y, std::uint32_t channel) {
  const double slope = static_cast<double>(x) / kShape.width;
  const double detail = std::sin(0.8 * x + channel) * std::cos(0.7 * y);
  return 0.02 + 0.55 * slope * slope + 0.02 * detail * slope;
}

bool is_subject(std::uint32_t x, std::uint32_t y, std::uint32_t sample) {
  const std::uint32_t left = 10 + 12 * sample;
  return x >= left && x < left + 40 && y < 77;
}

Picture picture_at(std::uint32_t sample, std::uint32_t exposed_as, std::uint32_t white) {
  Picture picture(kShape, white > 255 ? ValueType::code16 : ValueType::code8, white);
  std::size_t index = 0;
  for (std::uint32_t y = 0; y < kShape.height; ++y) {
    for (std::uint32_t x = 0; x < kShape.width; ++x) {
      for (std::uint32_t channel = 0; channel < kShape.channels; ++channel, ++index) {
        const double light = is_subject(x, y, sample) ? 0.004 : light_at(x, y, channel);
        const auto code = static_cast<std::uint16_t>(
            std::lround(white * std::min(code_of(light, exposed_as, channel), 1.0)));
        if (white > 255) {
          picture.values<std::uint16_t>()[index] = code;
        } else {
          picture.values<std::uint8_t>()[index] = static_cast<std::uint8_t>(code);
        }
      }
    }
  }
  return picture;
}

std::vector<std::vector<std::byte>> read_deflickered(const std::vector<Picture>& pictures,
                                                     std::vector<std::string>& remarks) {
  const Scratch scratch;
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    scratch.write("f" + std::to_string(k) + ".ppm", netpbm_file(pictures[k], false));
  }
  const auto clip = deflicker(open_test_clip(scratch.folder(), {.rate = Rational{100, 1}}));
  auto rasters = read_all(*clip);
  for (const Note& remark : clip->remarks()) remarks.push_back(remark.text);
  return rasters;
}

double code_in(const std::vector<std::byte>& raster, std::uint32_t white, std::size_t index) {
  return white > 255 ? static_cast<double>(reinterpret_cast<const std::uint16_t*>(raster.data())[index])
                     : static_cast<double>(std::to_integer<std::uint8_t>(raster[index]));
}

TEST(Deflicker, GivesTheSceneTheCodesOfTheFirstPicture) {
  for (const std::uint32_t white : {255u, 4095u}) {
    std::vector<Picture> pictures;
    for (std::uint32_t k = 0; k < kSamples; ++k) pictures.push_back(picture_at(k, k, white));
    std::vector<std::string> remarks;
    const auto rasters = read_deflickered(pictures, remarks);
    ASSERT_EQ(rasters.size(), kSamples);
    EXPECT_EQ(rasters[0], pictures[0].bytes);
    for (std::uint32_t k = 1; k < kSamples; ++k) {
      const Picture wanted = picture_at(k, 0, white);
      double squares = 0, before = 0;
      std::uint64_t count = 0;
      for (std::size_t i = 0; i < kShape.value_count(); ++i) {
        const auto x = static_cast<std::uint32_t>(i / 3 % kShape.width);
        const auto y = static_cast<std::uint32_t>(i / 3 / kShape.width);
        const double saturated = code_in(pictures[k].bytes, white, i);
        if (is_subject(x, y, k) || saturated == white) continue;
        squares +=
            std::pow((code_in(rasters[k], white, i) - code_in(wanted.bytes, white, i)) * 255 / white, 2);
        before += std::pow((saturated - code_in(wanted.bytes, white, i)) * 255 / white, 2);
        ++count;
      }
      EXPECT_LE(std::sqrt(squares / static_cast<double>(count)), 1.0)
          << "picture " << k << ", white " << white;
      EXPECT_GE(std::sqrt(before / static_cast<double>(count)), 5.0) << "picture " << k << " did not flicker";
    }
    ASSERT_EQ(remarks.size(), 1u);
    EXPECT_TRUE(remarks[0].starts_with("the exposure of 7 of 8 pictures was corrected, by up to "))
        << remarks[0];
  }
}

TEST(Deflicker, LeavesASteadyClipAsItIs) {
  std::vector<Picture> pictures;
  for (std::uint32_t k = 0; k < kSamples; ++k) pictures.push_back(picture_at(k, 0, 255));
  std::vector<std::string> remarks;
  const auto rasters = read_deflickered(pictures, remarks);
  for (std::uint32_t k = 0; k < kSamples; ++k) EXPECT_EQ(rasters[k], pictures[k].bytes) << k;
  EXPECT_TRUE(remarks.empty());
}

// What moves is brighter than all else, so that the brightest codes are told by few pairs and those beyond by none.
TEST(Deflicker, CorrectsNoiseNeitherWhereThingsMoveNorWhereNothingDoes) {
  for (const double deviation : {1.5, 5.0, 9.0}) {
    for (const double dimmed : {0.0, 0.1}) {
      for (const double radius : {0.0, 45.0}) {
        std::mt19937 random(3);
        std::normal_distribution<double> noise(0, deviation);
        std::vector<Picture> pictures;
        std::vector<double> gains;
        for (std::uint32_t k = 0; k < 24; ++k) {
          Picture& picture = pictures.emplace_back(Shape{320, 240, 1}, ValueType::code8, 255);
          gains.push_back(1 - dimmed * std::abs(std::sin(0.7 * k)));
          std::size_t index = 0;
          for (std::uint32_t y = 0; y < 240; ++y) {
            for (std::uint32_t x = 0; x < 320; ++x, ++index) {
              const double slope = 90 + 10 * std::sin(x / 7.0) * std::cos(y / 9.0);
              const double away = std::hypot(x - (40 + 10.0 * k), y - (120 + 40 * std::sin(k / 4.0)));
              const double code = away < radius ? 200 + 20 * std::sin(x / 4.0 - k) : slope;
              picture.values<std::uint8_t>()[index] =
                  static_cast<std::uint8_t>(std::lround(std::clamp(gains.back() * code + noise(random), 0.0, 255.0)));
            }
          }
        }
        std::vector<std::string> remarks;
        const auto rasters = read_deflickered(pictures, remarks);
        for (std::uint32_t k = 0; k < pictures.size(); ++k) {
          const bool is_alike = 90 * (1 - gains[k]) < 0.75;
          double off = 0;  // of the corner, which is background all along
          for (std::size_t i = 0; i < 320 * 30; ++i)
            off += code_in(rasters[k], 255, i) - code_in(pictures[k].bytes, 255, i) / gains[k];
          const std::string which = format("picture {}, deviation {}, radius {}", k, deviation, radius);
          if (dimmed == 0) {
            EXPECT_EQ(rasters[k], pictures[k].bytes) << which;
          } else if (!is_alike) {
            EXPECT_NEAR(off / (320 * 30), 0, 1) << which;
          }
        }
        EXPECT_EQ(remarks.empty(), dimmed == 0) << deviation << ", " << radius;
      }
    }
  }
}

// When signs are thrown, no more than the stated share is taken for a correction; the bound is for any sizes.
TEST(Deflicker, IsMisledByChanceNoMoreOftenThanItSays) {
  constexpr double kTrials = 20;
  std::mt19937 random(5);
  for (const double spread : {0.0, 1.0, 3.0}) {
    int misled = 0;
    for (int trial = 0; trial < 2000; ++trial) {
      std::vector<double> differences;
      for (int i = 0; i < 40; ++i)
        differences.push_back((random() % 2 == 0 ? 1 : -1) *
                              std::exp(spread * std::normal_distribution<double>()(random)));
      misled += may_be_chance(differences, kTrials) ? 0 : 1;
    }
    std::printf("by sizes of spread %.0f misled in %d of 2000, stated %.0f\n", spread, misled, 2000 / kTrials);
    EXPECT_LE(misled, 2000 / kTrials) << spread;
  }
  EXPECT_TRUE(may_be_chance(std::vector<double>(14, 1.0), 10'000));
  EXPECT_FALSE(may_be_chance(std::vector<double>(15, 1.0), 10'000));
  EXPECT_FALSE(may_be_chance(std::vector<double>(15, -1.0), 10'000));
}

TEST(Deflicker, SaysOfWhichPicturesTheExposureCannotBeTold) {
  std::vector<Picture> pictures = {picture_at(0, 0, 255), picture_at(1, 1, 255), random_stills(kShape, 255, 1, 7)[0],
                                   picture_at(3, 1, 255)};
  std::vector<std::string> remarks;
  const auto rasters = read_deflickered(pictures, remarks);
  ASSERT_EQ(remarks.size(), 2u);
  EXPECT_TRUE(remarks[1].starts_with("1 of 4 pictures follow no one curve from those before them"))
      << remarks[1];
  EXPECT_EQ(rasters.size(), 4u);
}

// Something comes to cover two thirds of what the first picture shows, half of that each time: only the picture before
// tells how the third was exposed.
TEST(Deflicker, TellsByThePictureBeforeWhatTheFirstDoesNotShow) {
  const Shape shape{240, 96, 1};
  std::vector<Picture> pictures;
  for (std::uint32_t k = 0; k < 3; ++k) {
    Picture& picture = pictures.emplace_back(shape, ValueType::code8, 255);
    for (std::uint32_t y = 0; y < shape.height; ++y) {
      for (std::uint32_t x = 0; x < shape.width; ++x) {
        const double code = x < 80 * k ? 40 + (x * 13 + y * 7) % 90 : 120 + (x + y * 3) % 80;
        picture.values<std::uint8_t>()[y * shape.width + x] = static_cast<std::uint8_t>(code * (k == 2 ? 0.8 : 1));
      }
    }
  }
  std::vector<std::string> remarks;
  const auto rasters = read_deflickered(pictures, remarks);
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_TRUE(remarks[0].starts_with("the exposure of 1 of 3")) << remarks[0];
  for (std::uint32_t y = 0; y < shape.height; ++y) {
    for (std::uint32_t x = 160; x < shape.width; ++x) {
      const std::size_t i = std::size_t{y} * shape.width + x;
      ASSERT_NEAR(code_in(rasters[2], 255, i), code_in(pictures[0].bytes, 255, i), 3) << x << ", " << y;
    }
  }
}

// A lit square on black, and a picture of too few pixels to tell a dimmed one from chance.
TEST(Deflicker, CorrectsASmallLitPartAndSaysWhatIsTooSmall) {
  const auto dimmed = [](const Shape& shape, std::uint32_t lit_width, std::uint32_t lit_height, double gain) {
    Picture picture(shape, ValueType::code8, 255);
    for (std::uint32_t y = 0; y < lit_height; ++y) {
      for (std::uint32_t x = 0; x < lit_width; ++x)
        picture.values<std::uint8_t>()[y * shape.width + x] = static_cast<std::uint8_t>(gain * (100 + 7 * x % 50));
    }
    return picture;
  };
  for (const Shape& shape : {Shape{320, 240, 1}, Shape{8, 8, 1}}) {
    const bool is_small = shape.width == 8;
    const std::uint32_t width = is_small ? 8 : 60, height = is_small ? 8 : 45;
    const std::vector<Picture> pictures = {dimmed(shape, width, height, 1), dimmed(shape, width, height, 0.7)};
    std::vector<std::string> remarks;
    const auto rasters = read_deflickered(pictures, remarks);
    ASSERT_EQ(remarks.size(), 1u);
    EXPECT_TRUE(remarks[0].starts_with(is_small ? "1 of 2 pictures follow no one curve" : "the exposure of 1 of 2"))
        << remarks[0];
    for (std::size_t i = 0; i < shape.value_count(); ++i)
      ASSERT_NEAR(code_in(rasters[1], 255, i), code_in(pictures[is_small ? 1 : 0].bytes, 255, i), is_small ? 0 : 2)
          << i;
  }
}

TEST(Deflicker, KeepsTheOrderOfCodes) {
  std::vector<Picture> pictures = {picture_at(0, 0, 255), picture_at(1, 1, 255)};
  const auto codes = pictures[1].values<std::uint8_t>();
  for (std::size_t i = 0; i < 3 * 256; ++i) codes[i] = static_cast<std::uint8_t>(i / 3);  // a ramp over all
  std::vector<std::string> remarks;
  const auto rasters = read_deflickered(pictures, remarks);
  ASSERT_NE(rasters[1], pictures[1].bytes);
  std::array<int, 3> seen{-1, -1, -1};
  for (std::size_t i = 0; i < 3 * 256; ++i) {
    const int code = std::to_integer<int>(rasters[1][i]);
    EXPECT_GE(code, seen[i % 3]) << i;
    seen[i % 3] = code;
  }
}

// A stage before black curtains is mostly black, which noise that is cut off at 0 makes a little brighter or darker.
TEST(CodeShift, IsNotToldByBlackAndWhite) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> noise(0, 1.0 / 255);
  for (const double factor : {1.0, 0.8}) {
    std::vector<double> codes, wanted;
    for (int i = 0; i < 1000; ++i) {
      codes.push_back(i < 600 ? noise(random) : i < 800 ? 1 : 0.1 + 0.7 * (i - 800) / 200);
      wanted.push_back(i < 600 ? noise(random) : i < 800 ? 1 : factor * codes.back());
    }
    const auto shift = CodeShift::between(codes, wanted);
    ASSERT_TRUE(shift) << factor;
    for (double code = 0.12; code < 0.78; code += 0.01)
      EXPECT_NEAR(code + shift->at(code), factor * code, 1.0 / 255) << factor;
  }
}

TEST(CodeShift, IsNoneOfDarkness) {
  std::vector<double> codes(1000, 0.0), wanted(1000, 0.4 / 255);
  wanted[3] = 0.9;  // a lamp
  const auto shift = CodeShift::between(codes, wanted);
  ASSERT_TRUE(shift);
  for (int knot = 0; knot <= 64; ++knot) EXPECT_EQ(shift->at(knot / 64.0), 0) << knot;
}

TEST(CodeShift, IsTheOneThatMostPairsAgreeOn) {
  // Every pair of codes twice as far apart, and a tenth of them something else.
  std::vector<double> codes, wanted;
  for (int i = 0; i < 1000; ++i) {
    codes.push_back(0.1 + 0.3 * i / 1000);
    wanted.push_back(i % 10 == 0 ? 0.9 : 2 * codes.back());
  }
  const auto shift = CodeShift::between(codes, wanted);
  ASSERT_TRUE(shift);
  for (double code = 0.12; code < 0.38; code += 0.01)
    EXPECT_NEAR(code + shift->at(code), 2 * code, 0.5 / 255);
}

}  // namespace
}  // namespace nutik::test
