#include "align/light_warp.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace nutik {
namespace {

struct Codes {
  Transfer transfer;
  std::uint32_t white;
};

// Steps of light hold no code's beginning, one, and thousands of them.
const std::vector<Codes> kCodes{{Transfer::srgb(), 255},      {Transfer::srgb(), 65'535},
                                {Transfer::linear(), 1},      {Transfer::linear(), 4095},
                                {Transfer::linear(), 65'535}, {Transfer::gamma(2.2), 1000},
                                {Transfer::pq(), 1023},       {Transfer::pq(), 65'535}};

TEST(LightTables, GiveTheCodesThatAreLookedUpOneByOne) {
  std::mt19937_64 random(7);
  for (const auto& [transfer, white] : kCodes) {
    const LightCodes single(transfer, white);
    std::vector<float> lights{0, 1, std::nextafter(1.0f, 0.0f), 1e-30f};
    for (const double threshold : transfer.code_thresholds(white)) {
      const auto light = static_cast<float>(threshold);
      for (const float near : {std::nextafter(light, 0.0f), light, std::nextafter(light, 1.0f)})
        lights.push_back(near);
    }
    for (int i = 0; i < 5000; ++i) lights.push_back(static_cast<float>(random() >> 40) / (1 << 24));
    std::vector<std::uint32_t> codes(lights.size());
    LightTables(transfer, white).codes_of(lights, codes.data());
    for (std::size_t i = 0; i < lights.size(); ++i) {
      ASSERT_EQ(codes[i], single.code_of(double{lights[i]})) << "white " << white << ", light " << lights[i];
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
    EXPECT_EQ(lights[i], static_cast<float>(single.light_of(raster[3 * i])));
  }
  const std::vector<std::uint16_t> above{1, 4096};
  EXPECT_THROW(tables.lights_of(above.data(), 1, {lights.data(), 2}), CodeAboveWhite);
}

}  // namespace
}  // namespace nutik
