#include "align/light_warp.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

namespace nutik {
namespace {

constexpr std::uint32_t kWidth = 61, kHeight = 47;

CaptureFormat format_of(std::uint32_t channels, std::uint32_t code_bytes, Transfer transfer) {
  return {.shape = {kWidth, kHeight, channels},
          .code_bytes = code_bytes,
          .white_code = code_bytes == 1 ? 255u : 65'535u,
          .transfer = transfer};
}

// Light that changes slowly: waves of 16 pixels and more.
double light_at(double x, double y, std::uint32_t channel) {
  return 0.5 + 0.2 * std::sin(0.39 * x + channel) + 0.2 * std::cos(0.3 * y - 0.2 * x);
}

template <typename Code>
std::vector<std::byte> drawn(const CaptureFormat& format, const Warp& from_places) {
  std::vector<std::byte> raster(format.sample_bytes());
  for (std::size_t i = 0; i < format.shape.value_count(); ++i) {
    const std::size_t pixel = i / format.shape.channels;
    const Place place = from_places.at(double(pixel % kWidth), double(pixel / kWidth));
    const double light = light_at(place.x, place.y, static_cast<std::uint32_t>(i % format.shape.channels));
    const auto code = static_cast<Code>(std::lround(format.transfer.fraction_of(light) * format.white_code));
    std::memcpy(raster.data() + i * sizeof code, &code, sizeof code);
  }
  return raster;
}

bool sees(const Warp& warp, std::size_t pixel) {
  const Place place = warp.at(double(pixel % kWidth), double(pixel / kWidth));
  return place.x >= 0 && place.y >= 0 && place.x <= kWidth - 1 && place.y <= kHeight - 1;
}

TEST(LightWarp, MovesCodesByWholePixelsAsTheyAre) {
  const CaptureFormat format = format_of(3, 1, Transfer::srgb());
  std::vector<std::byte> raster(format.sample_bytes());
  for (std::size_t i = 0; i < raster.size(); ++i) raster[i] = static_cast<std::byte>(i * 7919 % 256);
  const Rectangle area{5, 4, 40, 30};
  LightWarp warp(format, area);
  std::vector<std::byte> warped(std::size_t{40} * 30 * 3);
  warp.take(raster, Warp{{1, 0, 3, 0, 1, -2, 0, 0, 1}}, warped);
  for (std::size_t i = 0; i < warped.size(); ++i) {
    const std::size_t x = 5 + 3 + i / 3 % 40, y = 4 - 2 + i / 3 / 40;
    ASSERT_EQ(warped[i], raster[(y * kWidth + x) * 3 + i % 3]) << "value " << i;
  }
}

// The cubic keeps 0.999 of a wave of 16 pixels between pixels; a code of sRGB is up to 2.3 steps of light, and two of
// them were rounded.
TEST(LightWarp, ShowsLightWhereItLies) {
  const Warp turned{{std::cos(0.05), -std::sin(0.05), 3.3, std::sin(0.05), std::cos(0.05), -2.6, 0, 0, 1}};
  for (const auto& format : {format_of(1, 1, Transfer::srgb()), format_of(3, 2, Transfer::linear()),
                             format_of(3, 1, Transfer::gamma(2.2))}) {
    const auto draw = format.code_bytes == 1 ? drawn<std::uint8_t> : drawn<std::uint16_t>;
    const auto seen = draw(format, inverse(turned)), should = draw(format, Warp());
    LightWarp warp(format, Rectangle::whole(format.shape));
    std::vector<std::byte> is(format.sample_bytes());
    warp.take(seen, turned, is);
    for (std::size_t i = 0; i < format.shape.value_count(); ++i) {
      if (!sees(turned, i / format.shape.channels)) continue;
      const auto light = [&](const std::vector<std::byte>& raster) {
        std::uint16_t code = 0;
        std::memcpy(&code, raster.data() + i * format.code_bytes, format.code_bytes);
        return format.transfer.light_of(code / double(format.white_code));
      };
      ASSERT_NEAR(light(is), light(should), 0.005 + 2.5 / std::min(format.white_code, 255u)) << "value " << i;
    }
  }
}

std::uint32_t code_at(const std::vector<std::byte>& raster, std::size_t number, std::uint32_t code_bytes) {
  std::uint16_t code = 0;
  std::memcpy(&code, raster.data() + number * code_bytes, code_bytes);
  return code;
}

// The cubic through 4 x 4 pixels, kept within them, place by place and in double precision.
std::uint32_t moved_code(const CaptureFormat& format, const LightCodes& light, const std::vector<std::byte>& raster,
                         const Place& place, std::uint32_t channel) {
  const auto taps = [](double t) {
    return std::array<double, 4>{((-0.5 * t + 1) * t - 0.5) * t, (1.5 * t - 2.5) * t * t + 1,
                                 ((-1.5 * t + 2) * t + 0.5) * t, (0.5 * t - 0.5) * t * t};
  };
  const double left = std::floor(place.x), top = std::floor(place.y);
  const auto across = taps(place.x - left), down = taps(place.y - top);
  double sum = 0, least = 1, most = 0;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      const auto x = static_cast<std::size_t>(std::clamp(left + column - 1, 0.0, format.shape.width - 1.0)),
                 y = static_cast<std::size_t>(std::clamp(top + row - 1, 0.0, format.shape.height - 1.0));
      const std::size_t number = (y * format.shape.width + x) * format.shape.channels + channel;
      const double value = light.light_of(code_at(raster, number, format.code_bytes));
      sum += across[static_cast<std::size_t>(column)] * down[static_cast<std::size_t>(row)] * value;
      least = std::min(least, value);
      most = std::max(most, value);
    }
  }
  return light.code_of(std::clamp(sum, least, most));
}

// Moves noise, and counts the values that the new picture shows.
std::size_t expect_moved(CaptureFormat format, const Shape& shape, const Rectangle& area, const Warp& warp) {
  format.shape = shape;
  std::mt19937 random(5);
  const LightCodes light(format.transfer, format.white_code);
  std::vector<std::byte> raster(format.sample_bytes());
  for (std::byte& code : raster) code = static_cast<std::byte>(random() & 255);
  std::vector<std::byte> warped(std::size_t{area.width} * area.height * shape.channels * format.code_bytes);
  LightWarp(format, area).take(raster, warp, warped);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < warped.size() / format.code_bytes; ++i) {
    const std::size_t pixel = i / shape.channels;
    const Place place = warp.at(double(area.x + pixel % area.width), double(area.y + pixel / area.width));
    if (!(place.x >= 0 && place.y >= 0 && place.x <= shape.width - 1 && place.y <= shape.height - 1)) continue;
    ++seen;
    const std::uint32_t should =
        moved_code(format, light, raster, place, static_cast<std::uint32_t>(i % shape.channels));
    const double is = code_at(warped, i, format.code_bytes);
    EXPECT_NEAR(is, should, 1) << "value " << i << " at " << place.x << ", " << place.y;
    if (std::abs(is - should) > 1) break;
  }
  return seen;
}

const std::vector<CaptureFormat> kKinds{format_of(3, 1, Transfer::srgb()), format_of(1, 1, Transfer::srgb()),
                                        format_of(3, 2, Transfer::srgb()), format_of(1, 2, Transfer::srgb())};

// Pictures are moved in parts, and what a part comes from may be much larger than it, or lie beyond a side.
TEST(LightWarp, MovesEveryPartOfALargePicture) {
  const Warp slow{{0.99995, -0.01, 3.3, 0.01, 0.99995, -2.6, 0, 0, 1}}, turned{{0, -1, 400.3, 1, 0, -200.6, 0, 0, 1}},
      shrunk{{6, 0.5, -1700.2, 0.2, 5, -300.7, 0, 0, 1}}, leaned{{1.1, 0.1, -30, 0.05, 0.9, 2, 1e-4, -4e-4, 1}},
      flipped{{-1, 0, 699.5, 0, -1, 149.5, 0, 0, 1}};
  for (const CaptureFormat& format : kKinds) {
    const Shape shape{700, 150, format.shape.channels};
    for (const Warp& warp : {slow, turned, shrunk, leaned, flipped}) {
      EXPECT_GT(expect_moved(format, shape, Rectangle::whole(shape), warp), 1000 * shape.channels);
      EXPECT_GT(expect_moved(format, shape, {301, 33, 331, 101}, warp), 0U);
    }
  }
}

TEST(LightWarp, MovesPicturesOfOnePixelOrOneRow) {
  for (const CaptureFormat& format : kKinds) {
    const std::uint32_t channels = format.shape.channels;
    EXPECT_EQ(expect_moved(format, {1, 1, channels}, {0, 0, 1, 1}, Warp()), channels);
    const Warp along{{1, 0, 0.4, 0, 1, 0, 0, 0, 1}}, down{{1, 0, 0, 0, 1, 0.4, 0, 0, 1}};
    EXPECT_EQ(expect_moved(format, {300, 1, channels}, {0, 0, 300, 1}, along), 299 * channels);
    EXPECT_EQ(expect_moved(format, {1, 300, channels}, {0, 0, 1, 300}, down), 299 * channels);
  }
}

TEST(LightWarp, LeavesWhatThePictureDoesNotShow) {
  const CaptureFormat format = format_of(1, 1, Transfer::linear());
  const std::vector<std::byte> raster(format.sample_bytes(), std::byte{200});
  std::vector<std::byte> warped(format.sample_bytes(), std::byte{7});
  LightWarp warp(format, Rectangle::whole(format.shape));
  warp.take(raster, Warp{{1, 0, 2.5, 0, 1, 0, 0, 0, 1}}, warped);
  for (std::size_t i = 0; i < warped.size(); ++i) {
    const bool is_seen = i % kWidth <= kWidth - 1 - 3;  // 2.5 to the right of it lies within the picture
    ASSERT_EQ(warped[i], std::byte(is_seen ? 200 : 7)) << "value " << i;
  }
}

TEST(LightWarp, MakesNoHaloesRoundEdges) {
  const CaptureFormat format = format_of(1, 1, Transfer::srgb());
  std::vector<std::byte> raster(format.sample_bytes());
  for (std::size_t i = 0; i < raster.size(); ++i) raster[i] = std::byte(i % kWidth < 30 ? 20 : 240);
  std::vector<std::byte> warped(raster.size());
  LightWarp warp(format, Rectangle::whole(format.shape));
  const Warp moved{{1, 0, 0.4, 0, 1, 0.3, 0, 0, 1}};
  warp.take(raster, moved, warped);
  for (std::size_t i = 0; i < warped.size(); ++i) {
    if (!sees(moved, i)) continue;
    ASSERT_GE(warped[i], std::byte{20}) << "value " << i;
    ASSERT_LE(warped[i], std::byte{240}) << "value " << i;
  }
}

// A path that was written by hand: within the slack of what a picture saw, and far outside of it.
TEST(LightWarp, StaysWithinThePictureHoweverSteepTheWarp) {
  const CaptureFormat format = format_of(1, 1, Transfer::linear());
  const std::vector<std::byte> raster(format.sample_bytes(), std::byte{50});
  LightWarp warp(format, Rectangle::whole(format.shape));
  for (const double sign : {1.0, -1.0}) {
    std::vector<std::byte> warped(format.sample_bytes(), std::byte{50});
    warp.take(raster, Warp{{999'999.5, 0, -1e6 * sign, 0, 1e-5, 0, 0, 0, 1e-5}}, warped);
    EXPECT_EQ(warped, raster);
  }
}

TEST(LightWarp, SaysThatACodeIsAboveWhite) {
  CaptureFormat format = format_of(1, 1, Transfer::linear());
  format.white_code = 100;
  const std::vector<std::byte> raster(format.sample_bytes(), std::byte{101});
  std::vector<std::byte> warped = raster;
  LightWarp warp(format, Rectangle::whole(format.shape));
  EXPECT_THROW(warp.take(raster, Warp(), warped), CodeAboveWhite);
}

TEST(LightWarp, SaysThatACodeIsAboveWhiteWhereNothingIsShownOfIt) {
  for (const std::uint32_t code_bytes : {1U, 2U}) {
    CaptureFormat format = format_of(3, code_bytes, Transfer::linear());
    format.white_code = code_bytes == 1 ? 254 : 0xFEFF;
    std::vector<std::byte> raster(format.sample_bytes(), std::byte{0xFE});
    std::vector<std::byte> warped(std::size_t{8} * 8 * 3 * code_bytes);
    const LightWarp warp(format, {4, 4, 8, 8});
    EXPECT_NO_THROW(warp.take(raster, Warp(), warped));
    std::fill(raster.end() - code_bytes, raster.end(), std::byte{0xFF});
    EXPECT_THROW(warp.take(raster, Warp(), warped), CodeAboveWhite);
  }
}

struct Codes {
  Transfer transfer;
  std::uint32_t white;
};

// Steps of light hold no code's beginning, one, and thousands of them.
const std::vector<Codes> kCodes{{Transfer::srgb(), 255},      {Transfer::srgb(), 65'535},
                                {Transfer::linear(), 1},      {Transfer::linear(), 4095},
                                {Transfer::linear(), 65'535}, {Transfer::gamma(2.2), 1000},
                                {Transfer::pq(), 1023},       {Transfer::pq(), 65'535},
                                {Transfer::gamma(10), 255},   {Transfer::gamma(10), 65'535},
                                {Transfer::gamma(0.1), 255},  {Transfer::gamma(0.1), 65'535},
                                {Transfer::log("slog3"), 1023},   {Transfer::log("slog3"), 65'535}};

// Between codes of other light the cubic counts one pixel only.
TEST(LightWarp, MovesEveryCodeByWholePixelsAsItIs) {
  for (const auto& [transfer, white] : kCodes) {
    CaptureFormat format = format_of(1, 2, transfer);
    format.shape.width = format.shape.height = 256;
    format.white_code = white;
    std::vector<std::uint16_t> raster(format.shape.value_count()), warped(raster.size());
    for (std::size_t i = 0; i < raster.size(); ++i) raster[i] = static_cast<std::uint16_t>(i % (white + 1));
    LightWarp(format, Rectangle::whole(format.shape))
        .take(std::as_bytes(std::span(raster)), Warp{{1, 0, 1, 0, 1, 0, 0, 0, 1}},
              std::as_writable_bytes(std::span(warped)));
    for (std::size_t i = 0; i < raster.size(); ++i) {
      if (i % 256 == 255) continue;
      ASSERT_EQ(warped[i], raster[i + 1]) << "white " << white << ", value " << i;
    }
  }
}

TEST(LightTables, GiveTheCodesThatAreLookedUpOneByOne) {
  std::mt19937_64 random(7);
  for (const auto& [transfer, white] : kCodes) {
    const LightCodes single(transfer, white);
    constexpr float kWhite = LightTables::kWhite;
    std::vector<float> lights{0, kWhite, std::nextafter(kWhite, 0.0f), 1e-30f * kWhite, 1e-30f};
    for (const double threshold : transfer.code_thresholds(white)) {
      const auto light = static_cast<float>(kWhite * threshold);
      for (const float near : {std::nextafter(light, 0.0f), light, std::nextafter(light, kWhite)})
        lights.push_back(near);
    }
    for (int i = 0; i < 5000; ++i) lights.push_back(static_cast<float>(random() >> 40) / (1 << 24) * kWhite);
    std::vector<std::uint32_t> codes(lights.size());
    LightTables(transfer, white).codes_of(lights, codes.data());
    for (std::size_t i = 0; i < lights.size(); ++i) {
      ASSERT_EQ(codes[i], single.code_of(double{lights[i]} / kWhite)) << "white " << white << ", light " << lights[i];
    }
  }
}

TEST(LightTables, GiveTheLightOfEveryNthCode) {
  const std::vector<std::uint16_t> raster{1, 2, 3, 4095, 5, 6, 0};
  std::vector<float> lights(3);
  const LightTables tables(Transfer::srgb(), 4095);
  tables.lights_of(raster.data(), 3, lights);
  const LightCodes single(Transfer::srgb(), 4095);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    EXPECT_EQ(lights[i], static_cast<float>(LightTables::kWhite * single.light_of(raster[3 * i])));
  }
  const std::vector<std::uint16_t> above{1, 4096};
  EXPECT_THROW(tables.lights_of(above.data(), 1, {lights.data(), 2}), CodeAboveWhite);
}

}  // namespace
}  // namespace nutik
