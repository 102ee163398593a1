// Maps and bounds of what is held, against the light that was filmed.
#include "session/uncertainty.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "capture/format.hpp"
#include "session/session.hpp"
#include "support/scratch.hpp"

namespace nutik {
namespace {

// 16 x 16 pixels that have every code once. What is held is the first sample's; the second is darker by the tolerance
// that it is held by, the third brighter.
class Ramps : public ::testing::TestWithParam<std::uint32_t> {
 protected:
  Ramps() {
    const auto modules = std::filesystem::path(NUTIK_TEST_PROGRAM).parent_path();
    setenv("NUTIK_MODULES", modules.c_str(), 0);
    source_.path = scratch_ / "ramps";
    source_.clip.rate = Rational{100, 1};
    std::filesystem::create_directory(source_.path);
    const int tolerance = static_cast<int>(GetParam());
    for (const int step : {0, -tolerance, tolerance}) {
      std::string file = "P5 16 16 255\n";
      for (int code = 0; code < 256; ++code) file += static_cast<char>(std::clamp(code + step, 0, 255));
      scratch_.write(format("ramps/{}.pgm", ++count_), file);
    }
  }

  [[nodiscard]] Session session(std::uint32_t tolerance) {
    ComputingRequest computing;
    computing.renderer = RendererKind::reference;
    source_.tolerance = tolerance;
    return Session(source_, computing);
  }

  test::Scratch scratch_;
  SourceRequest source_;
  int count_ = 0;
};

TEST_P(Ramps, NoPixelIsFurtherFromTheFilmedLightThanItsMap) {
  Session held = session(GetParam()), filmed = session(0);
  Mask mask = Mask::uniform(16, 16, 0);
  for (std::uint64_t pixel = 1; pixel < 256; pixel += 2)
    mask.mixed.add(pixel, std::array<Share, 2>{{{0, 40'000}, {9, 25'535}}});
  double most = 0.0;
  for (const char* captured : {"linear", "srgb", "bt709", "gamma:2.2", "gamma:0.5", "hlg", "pq"}) {
    PlanOptions options;
    options.transfer = Transfer::parse(captured);
    for (const char* shown : {"", "srgb", "linear", "gamma:2.2", "gamma:0.5", "pq"}) {
      OutputFormat output;
      if (*shown != '\0') output.transfer = Transfer::parse(shown);
      output.maps_bounds = true;
      CaptureFormat capture = held.format();
      capture.transfer = *options.transfer;
      const CodeMaking making = CodeMaking::of(capture, output);
      double share = 0.0;
      for (const double scale : {0.5, 1.0, 3.0}) {
        for (const std::int64_t sample : {1, 2}) {
          const auto from = sample * 10'000'000;
          const FunctionSet functions{{0, GainFunction::boxcar(from, from + 10'000'000, scale)},
                                      {9, GainFunction::boxcar(from, from + 10'000'000, scale / 3)}};
          const ExposedPicture picture = held.render(functions, mask, options, output);
          const auto light = filmed.render(functions, mask, options, {ValueType::light64, 0}).picture;
          const auto map = picture.bounds.front().values.values<float>();
          const auto codes = picture.picture.values<std::uint8_t>();
          const double whole = picture.uncertainty.bounds.error->steps;
          for (std::size_t pixel = 0; pixel < 256; ++pixel) {
            const double shown_light = std::clamp(light.values<double>()[pixel] / making.white_light, 0.0, 1.0);
            const double off = std::fabs(255 * making.transfer.fraction_of(shown_light) - codes[pixel]);
            ASSERT_LE(off, map[pixel]) << captured << " to " << shown << ", S " << scale << ", pixel " << pixel;
            ASSERT_LE(off, whole) << captured << " to " << shown << ", S " << scale << ", pixel " << pixel;
            share = std::max(share, off / double{map[pixel]});
          }
        }
      }
      most = std::max(most, share);
      EXPECT_GT(share, 0.2) << captured << " to " << shown << ": the map says nothing";
    }
  }
  std::printf("the largest share of a map that was used: %.3f\n", most);
  EXPECT_GT(most, 0.9);
}

INSTANTIATE_TEST_SUITE_P(Tolerances, Ramps, ::testing::Values(1u, 4u, 8u));

}  // namespace
}  // namespace nutik
