// Phantom cameras' packed files: codes of 10 bits become 12 bits that are proportional to light, by the format's table,
// which is held to the curve it is made from.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numeric>

#include "support/ffmpeg.hpp"

namespace nutik::test {
namespace {

constexpr std::uint32_t kPacked10 = 256, kPacked12 = 1024;

void put(std::string& bytes, std::size_t at, std::uint64_t value, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) bytes[at + i] = static_cast<char>(value >> (8 * i) & 255);
}

// Codes as digits behind one another, as the format's description draws them, and those as bytes.
std::string packed(const std::vector<std::uint16_t>& codes) {
  std::string digits, bytes;
  for (const std::uint16_t code : codes) {
    for (int bit = 9; bit >= 0; --bit) digits += (code >> bit & 1) != 0 ? '1' : '0';
  }
  for (std::size_t at = 0; at < digits.size(); at += 8) {
    bytes += static_cast<char>(std::stoi(digits.substr(at, 8), nullptr, 2));
  }
  return bytes;
}

struct Recording {
  std::uint32_t compression = kPacked10;
  std::uint32_t depth = 10;
  std::uint32_t black = 0;
  std::uint32_t mosaic = 0;  // 4: red and green first
  bool is_flipped = false;   // shown bottom row first
  std::vector<std::int64_t> times_us = {};
};

// A file of grey pictures of 32 pixels in each row, their codes packed into 10 bits; 1000 a second, exposed for 250 µs.
std::string phantom_file(const std::vector<std::vector<std::uint16_t>>& pictures, const Recording& of) {
  constexpr std::size_t kHeader = 44, kBitmap = 40, kSetup = 5740, kWidth = 32;
  const std::size_t height = pictures.front().size() / kWidth,
                    tags = of.times_us.empty() ? 0 : 8 + 8 * of.times_us.size(),
                    offsets = kHeader + kBitmap + kSetup + tags;
  std::string bytes(offsets + 8 * pictures.size(), '\0');
  bytes.replace(0, 2, "CI");
  put(bytes, 2, kHeader, 2);
  put(bytes, 4, of.mosaic != 0 ? 2 : 0, 2);
  put(bytes, 6, 1, 2);
  put(bytes, 20, pictures.size(), 4);
  put(bytes, 24, kHeader, 4);
  put(bytes, 28, kHeader + kBitmap, 4);
  put(bytes, 32, offsets, 4);
  put(bytes, kHeader, kBitmap, 4);
  put(bytes, kHeader + 4, kWidth, 4);
  put(bytes, kHeader + 8, height, 4);
  put(bytes, kHeader + 12, 1, 2);
  put(bytes, kHeader + 14, 16, 2);  // of what is packed, as cameras write it
  put(bytes, kHeader + 16, of.compression, 4);
  const std::size_t setup = kHeader + kBitmap;
  bytes.replace(setup + 140, 2, "ST");
  put(bytes, setup + 142, kSetup, 2);
  put(bytes, setup + 760, of.is_flipped ? 1 : 0, 4);
  put(bytes, setup + 768, 1000, 4);
  put(bytes, setup + 772, 250, 4);
  put(bytes, setup + 808, of.mosaic, 4);
  put(bytes, setup + 896, of.depth, 4);
  put(bytes, setup + 5732, of.black, 4);
  if (tags > 0) {
    put(bytes, setup + kSetup, tags, 4);
    put(bytes, setup + kSetup + 4, 1002, 2);
  }
  for (std::size_t k = 0; k < of.times_us.size(); ++k) {
    // Since 1970, in 2^-32 s.
    const auto since = static_cast<double>(of.times_us[k]) * 1e-6 * 4294967296.0;
    put(bytes, setup + kSetup + 8 + 8 * k,
        (std::uint64_t{1'700'000'000} << 32) + static_cast<std::uint64_t>(since), 8);
  }
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    put(bytes, offsets + 8 * k, bytes.size(), 8);
    const std::string picture = packed(pictures[k]);
    std::string sizes(8, '\0');
    put(sizes, 0, 8, 4);
    put(sizes, 4, picture.size(), 4);
    bytes += sizes + picture;
  }
  return bytes;
}

std::vector<std::uint16_t> all_codes() {
  std::vector<std::uint16_t> codes(1024);
  std::iota(codes.begin(), codes.end(), std::uint16_t{0});
  return codes;
}

std::vector<std::uint16_t> values_of(const std::vector<std::byte>& raster) {
  std::vector<std::uint16_t> values(raster.size() / 2);
  std::memcpy(values.data(), raster.data(), raster.size());
  return values;
}

class PhantomClip : public testing::Test {
 protected:
  std::unique_ptr<Clip> open(const std::vector<std::vector<std::uint16_t>>& pictures, const Recording& of) {
    return open_test_clip(scratch_.write("clip.cine", phantom_file(pictures, of)));
  }

  Scratch scratch_;
};

TEST_F(PhantomClip, IsTurnedOverWhereItSaysSo) {
  std::vector<std::uint16_t> rows(64, 100);
  std::fill_n(rows.begin(), 32, std::uint16_t{900});
  Recording of;
  const auto upright = values_of(read_all(*open({rows}, of)).at(0));
  of.is_flipped = true;
  const auto flipped = values_of(read_all(*open({rows}, of)).at(0));
  EXPECT_NE(upright.front(), upright.back());
  EXPECT_EQ(flipped.front(), upright.back());
  EXPECT_EQ(flipped.back(), upright.front());
}

// The camera's own times go before the rate that it states, and where they tell another that is said.
TEST_F(PhantomClip, SaysWhereItsTimesAreNotOfTheRateThatItStates) {
  const std::vector<std::vector<std::uint16_t>> pictures(5, std::vector<std::uint16_t>(32, 500));
  const auto told = [&](std::vector<std::int64_t> times_us) {
    Recording of;
    of.times_us = std::move(times_us);
    const auto clip = open(pictures, of);
    return std::pair(clip->info().timing, clip->info().notes);
  };
  EXPECT_TRUE(told({0, 1000, 2000, 3000, 4000}).second.empty());
  const auto [tenth, said] = told({0, 9997, 19994, 29991, 39988});
  ASSERT_TRUE(tenth.rate);
  EXPECT_NEAR(tenth.rate->value(), 1e6 / 9997, 1e-4);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0].text,
            "the camera states 1000 pictures a second, and by the times that it wrote down the file has "
            "100.03, one in "
            "10 of 1000.3. These times are taken; state a rate if they are wrong");
  EXPECT_EQ(said[0].settings, std::vector{Setting::frame_rate});
  const auto near = told({0, 990, 1980, 2970, 3960}).second;
  ASSERT_EQ(near.size(), 1u);
  expect_says(near[0].text, "the file has 1010.1. These times");
  const auto [uneven, gaps] = told({0, 1000, 3000, 4000, 5000});
  EXPECT_FALSE(uneven.rate);
  ASSERT_EQ(gaps.size(), 1u);
  expect_says(gaps[0].text, "the file has them ");
}

// ITU-R BT.709's curve backwards, from black to white.
double bt709_light(double code) {
  const double share = (code - 63.5) / 955.0;
  return 63.7 + 4039.4 * (share < 0.081 ? share / 4.5 : std::pow((share + 0.099) / 1.099, 1 / 0.45));
}

TEST_F(PhantomClip, CodesOf10BitsStandForLightOf12) {
  const auto codes = all_codes();
  std::vector<std::uint16_t> backwards(codes.rbegin(), codes.rend());
  const auto clip = open({codes, backwards}, {});
  EXPECT_EQ(clip->info().format.shape, (Shape{32, 32, 1}));
  EXPECT_EQ(clip->info().format.white_code, 4095u);
  EXPECT_EQ(clip->info().format.transfer, Transfer::linear());
  EXPECT_EQ(clip->info().timing.rate, (Rational{1000, 1}));
  EXPECT_EQ(clip->info().timing.exposed_ns, 250'000);
  const auto rasters = read_all(*clip);
  ASSERT_EQ(rasters.size(), 2u);
  const auto light = values_of(rasters[0]);
  EXPECT_EQ(light[0], 2);
  EXPECT_EQ(light[64], 64) << "black";
  EXPECT_EQ(light[512], 998);
  EXPECT_EQ(light[1014], 4064) << "white";
  double worst = 0;
  for (std::size_t code = 1; code <= 1014; ++code) {
    worst = std::max(worst, std::abs(light[code] - bt709_light(static_cast<double>(code))));
    EXPECT_GE(light[code], light[code - 1]) << code;
  }
  EXPECT_LT(worst, 1.0);
  RecordProperty("worst", std::to_string(worst));
  for (std::size_t code = 1015; code < 1024; ++code) EXPECT_EQ(light[code], 4095) << code;
  const auto last = values_of(rasters[1]);
  EXPECT_TRUE(std::equal(light.rbegin(), light.rend(), last.begin()));
}

// Some programs write the depth of what the table makes of the codes.
TEST_F(PhantomClip, TheDepthInTheFileChangesNothing) {
  const auto expected = read_all(*open({all_codes()}, {}));
  EXPECT_EQ(read_all(*open({all_codes()}, {.depth = 12})), expected);
}

// Nothing here knows what of it is black and white, nor its colours.
TEST_F(PhantomClip, AMosaicIsRefusedWithAWayOut) {
  expect_clip_refused(
      scratch_.write("clip.cine", phantom_file({std::vector<std::uint16_t>(1024, 512)}, {.mosaic = 4})), {},
      "holds the mosaic of a colour sensor, whose black, white and colours are not known here: save");
}

TEST_F(PhantomClip, TheCamerasBlackIsNamed) {
  const auto clip = open({all_codes()}, {.black = 64});
  ASSERT_EQ(clip->info().notes.size(), 1u);
  expect_says(clip->info().notes[0].text, "black is code 64 of 4095");
}

TEST_F(PhantomClip, CodesOf12PackedBitsAreRefused) {
  expect_clip_refused(scratch_.write("clip.cine", phantom_file({all_codes()}, {.compression = kPacked12})),
                      {}, "12 bits, packed two in three bytes, which are not read");
}

}  // namespace
}  // namespace nutik::test
