// Maps and bounds of what is held, against the light that was filmed.
#include "session/uncertainty.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "capture/format.hpp"
#include "render/code_scale.hpp"
#include "session/session.hpp"
#include "support/clips.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

// How far a picture's codes are from the light that was filmed, in what its map allows: the largest share. That holds,
// and the bound of all of it.
double share_of_map(const ExposedPicture& picture, Picture filmed, const CaptureFormat& capture,
                    const std::string& what) {
  const CodeMaking making = CodeMaking::of(capture, picture.output);
  to_shown_light(filmed, making);
  const std::uint32_t channels = filmed.shape.channels;
  const auto map = picture.bounds.front().values.values<float>();
  const auto codes = picture.picture.values<std::uint8_t>();
  double share = 0.0;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const double light = std::clamp(filmed.values<double>()[i], 0.0, 1.0);
    const double off = std::fabs(255 * making.transfer.fraction_of(light) - codes[i]), allowed = map[i / channels];
    EXPECT_LE(off, allowed) << what << ", value " << i;
    EXPECT_LE(off, picture.uncertainty.bounds.error->steps) << what << ", value " << i;
    if (::testing::Test::HasFailure()) return share;
    share = std::max(share, off / allowed);
  }
  return share;
}

const UncertaintyTerm& term_of(const ExposedPicture& picture, std::string_view name) {
  return *std::ranges::find(picture.uncertainty.terms, name, &UncertaintyTerm::name);
}

// What a picture's layer has, its largest pixel's.
float most_of(const ExposedPicture& picture, std::string_view layer) {
  const auto found = std::ranges::find(picture.bounds, layer, &PictureLayer::name);
  return std::ranges::max(found->values.values<float>());
}

class Held : public ::testing::Test {
 protected:
  explicit Held(const std::string& name) {
    use_modules();
    source_.path = scratch_ / name;
    source_.clip.rate = Rational{100, 1};
    std::filesystem::create_directory(source_.path);
  }

  void write(const std::string& file) {
    scratch_.write(format("{}/{}.ppm", source_.path.filename().string(), ++count_), file);
  }

  [[nodiscard]] Session session(std::uint32_t tolerance) {
    ComputingRequest computing;
    computing.renderer = RendererKind::reference;
    source_.tolerance = tolerance;
    return Session(source_, computing);
  }

  Scratch scratch_;
  SourceRequest source_;
  int count_ = 0;
};

constexpr std::int64_t kSampleNs = 10'000'000;

// 16 x 16 pixels that have every code once. What is held is the first sample's; the second is darker by the tolerance
// that it is held by, the third brighter.
class Ramps : public Held, public ::testing::WithParamInterface<std::uint32_t> {
 protected:
  Ramps() : Held("ramps") {
    const int tolerance = static_cast<int>(GetParam());
    for (const int step : {0, -tolerance, tolerance}) {
      std::string file = "P5 16 16 255\n";
      for (int code = 0; code < 256; ++code) file += static_cast<char>(std::clamp(code + step, 0, 255));
      write(file);
    }
  }
};

TEST_P(Ramps, NoPixelIsFurtherFromTheFilmedLightThanItsMap) {
  Session held = session(GetParam()), filmed = session(0);
  Mask mask = Mask::uniform(16, 16, 0);
  for (std::uint64_t pixel = 1; pixel < 256; pixel += 2)
    mask.mixed.add(pixel, std::array<Share, 2>{{{0, 40'000}, {9, 25'535}}});
  double most = 0.0;
  for (const char* captured : {"linear", "srgb", "bt709", "gamma:2.2", "gamma:0.5", "hlg", "pq", "slog3", "applelog"}) {
    const PlanOptions options{.transfer = Transfer::parse(captured)};
    CaptureFormat capture = held.format();
    capture.transfer = *options.transfer;
    for (const char* shown : {"", "srgb", "linear", "gamma:2.2", "gamma:0.5", "pq", "slog3", "applelog"}) {
      OutputFormat output;
      if (*shown != '\0') output.transfer = Transfer::parse(shown);
      output.maps_bounds = true;
      const std::string what = format("{} to {}", captured, shown);
      double share = 0.0;
      for (const double scale : {0.5, 1.0, 3.0}) {
        for (const std::int64_t from : {kSampleNs, 2 * kSampleNs}) {
          const FunctionSet functions{{0, GainFunction::boxcar(from, from + kSampleNs, scale)},
                                      {9, GainFunction::boxcar(from, from + kSampleNs, scale / 3)}};
          const ExposedPicture picture = held.render(functions, mask, options, output);
          const Picture light = filmed.render(functions, mask, options, {ValueType::light64, 0}).picture;
          share = std::max(share, share_of_map(picture, light, capture, what));
          ASSERT_FALSE(HasFailure());
        }
      }
      most = std::max(most, share);
      EXPECT_GT(share, 0.2) << what << ": the map says nothing";
    }
  }
  std::printf("the largest share of a map that was used: %.3f\n", most);
  EXPECT_GT(most, 0.9);
}

// Samples that are combined are no mean: the lightest, darkest or middle one of each pixel.
TEST_P(Ramps, CombinedSamplesAreNoFurtherFromTheFilmedOnes) {
  Session held = session(GetParam()), filmed = session(0);
  Mask mask = Mask::uniform(16, 16, 0);
  for (std::uint64_t pixel = 1; pixel < 256; pixel += 2)
    mask.mixed.add(pixel, std::array<Share, 2>{{{0, 40'000}, {9, 25'535}}});
  const FunctionSet functions{{0, GainFunction({{0, 0.5}, {3 * kSampleNs, 2.0}})},
                              {9, GainFunction::boxcar(kSampleNs, 3 * kSampleNs, 0.7)}};
  double most = 0.0;
  for (const char* captured : {"linear", "srgb", "gamma:2.2", "gamma:0.5", "pq"}) {
    for (const Combine combine : {Combine::lighten, Combine::darken, Combine::median}) {
      const PlanOptions options{.transfer = Transfer::parse(captured), .combine = combine};
      OutputFormat output;
      output.maps_bounds = true;
      CaptureFormat capture = held.format();
      capture.transfer = *options.transfer;
      const ExposedPicture picture = held.render(functions, mask, options, output);
      const Picture light = filmed.render(functions, mask, options, {ValueType::light64, 0}).picture;
      most = std::max(most, share_of_map(picture, light, capture, captured));
      ASSERT_FALSE(HasFailure());
      EXPECT_EQ(std::ranges::count(picture.bounds, "times", &PictureLayer::name), 0) << "nothing is added up";
    }
  }
  EXPECT_GT(most, 0.7);
}

// A function that is held behind its end weighs more where it comes earlier: the row that is exposed first has the most
// light.
TEST_P(Ramps, HeldEndsOfDelayedFunctionsCountWhereTheyWeighMost) {
  Session held = session(GetParam()), filmed = session(0);
  const FunctionSet functions{{0, GainFunction({{0, 0.001}, {3 * kSampleNs, 0.001}, {3 * kSampleNs + 100'000, 1.0}})}};
  const PlanOptions options{
      .transfer = Transfer::linear(),
      .delays = std::make_shared<const DelayMap>(DelayMap::by_rows({16, 16, 1}, {0, -5 * kSampleNs / 2}))};
  CaptureFormat capture = held.format();
  capture.transfer = *options.transfer;
  OutputFormat output;
  output.maps_bounds = true;
  const ExposedPicture picture = held.render(functions, Mask::uniform(16, 16, 0), options, output);
  const Picture light = filmed.render(functions, Mask::uniform(16, 16, 0), options, {ValueType::light64, 0}).picture;
  EXPECT_GT(share_of_map(picture, light, capture, "held"), 0.4);
  EXPECT_GE(picture.uncertainty.scale, std::ranges::max(light.values<double>()));
}

INSTANTIATE_TEST_SUITE_P(Tolerances, Ramps, ::testing::Values(1u, 4u, 8u));

// 64 colours of BT.2020, shown in BT.709's primaries, which mix their errors: by the light of all three channels.
class Colours : public Held {
 protected:
  Colours() : Held("colours") {
    source_.clip.primaries = Primaries::bt2020;
    for (const int step : {0, -4, 4}) {
      std::string file = "P6 8 8 255\n";
      for (int pixel = 0; pixel < 64; ++pixel) {
        for (const int place : {pixel % 4, pixel / 4 % 4, pixel / 16}) {
          const int sign = place % 2 == pixel % 2 ? 1 : -1;  // so that errors of channels add up and cancel
          file += static_cast<char>(std::clamp(40 + 50 * place + sign * step, 0, 255));
        }
      }
      write(file);
    }
  }
};

TEST_F(Colours, OtherPrimariesHaveTheErrorsOfTheLightsThatTheyMix) {
  Session held = session(4), filmed = session(0);
  const Mask mask = Mask::uniform(8, 8, 0);
  double most = 0.0;
  for (const char* shown : {"srgb", "gamma:2.2", "linear"}) {
    for (const double scale : {0.4, 1.0}) {
      OutputFormat output;
      output.transfer = Transfer::parse(shown);
      output.maps_bounds = true;
      for (const std::int64_t from : {kSampleNs, 2 * kSampleNs}) {
        const FunctionSet functions{{0, GainFunction::boxcar(from, from + kSampleNs, scale)}};
        const ExposedPicture picture = held.render(functions, mask, {}, output);
        const Picture light = filmed.render(functions, mask, {}, {ValueType::light64, 0}).picture;
        most = std::max(most, share_of_map(picture, light, held.format(), shown));
        ASSERT_FALSE(HasFailure());
        const auto map = picture.bounds.front().values.values<float>();
        EXPECT_LT(std::ranges::min(map), 0.5 * picture.uncertainty.bounds.error->steps) << "it is flat";
      }
    }
  }
  std::printf("the largest share of a map of colours that was used: %.3f\n", most);
  EXPECT_GT(most, 0.5);
}

// A camera that is noisy in its brightest code alone.
class Noisy : public Held {
 protected:
  Noisy() : Held("noisy") {
    for (int k = 0; k < 3; ++k) write("P5 4 1 255\n" + std::string{'\x10', '\x40', '\x7f', '\xe0'});
    source_.clip.transfer = Transfer::linear();
    source_.noise = StatedNoise{
        "camera", CameraNoise{255, Transfer::linear(), {{NoiseCurve::points, 0, 0, {{0, 0.25, 1}, {255, 8, 1}}}}}};
  }
};

// An offset picture's codes do not say which light they are of: its noise is the largest that there is.
TEST_F(Noisy, WhereLightIsNotKnownTheNoiseIsTheMost) {
  Session held = session(0);
  const FunctionSet functions{{0, GainFunction::boxcar(0, kSampleNs, 1.0)}};
  OutputFormat output;
  output.maps_bounds = true;
  const auto noise_of = [&](NegativeLight negative) {
    output.negative = negative;
    const ExposedPicture picture = held.render(functions, Mask::uniform(4, 1, 0), {}, output);
    const auto found = std::ranges::find(picture.bounds, "noise", &PictureLayer::name);
    const auto values = found->values.values<float>();
    return std::pair(std::ranges::min(values), std::ranges::max(values));
  };
  EXPECT_LT(noise_of(NegativeLight::saturate).first, 1.0F);
  EXPECT_GE(noise_of(NegativeLight::offset).first, noise_of(NegativeLight::saturate).second);
}

// Means of four pixels each, rounded to codes of 8 bits.
class Scaled : public Held {
 protected:
  Scaled() : Held("scaled") {
    Random random(5);
    for (int k = 0; k < 4; ++k) {
      std::string file = "P5 64 64 255\n";
      for (int pixel = 0; pixel < 64 * 64; ++pixel) file += static_cast<char>(random.whole(0, pixel / 16));
      write(file);
    }
  }
};

// A mean of sRGB's codes that are half a code off is that off, and 1.4 times as much behind the straight toe. By the
// codes of black it was 15.
TEST_F(Scaled, LightThatWasRoundedIsBoundByItsOwn) {
  Session filmed = session(0);
  source_.clip.scale = ClipScale{2, 0, 0};
  Session rounded = session(0);
  ASSERT_EQ(rounded.format().shape.width, 32u);
  double most = 0.0, of_light = 0.0;
  for (const std::int64_t samples : {1, 3}) {
    const FunctionSet functions{{0, GainFunction::boxcar(0, samples * kSampleNs)}};
    const Picture fine = filmed.render(functions, Mask::uniform(64, 64, 0), {}, {ValueType::light64, 0}).picture;
    Picture light({32, 32, 1}, ValueType::light64, 0);
    for (std::size_t i = 0; i < 32 * 32; ++i) {
      const auto at = [&](std::size_t x, std::size_t y) {
        return fine.values<double>()[(i / 32 * 2 + y) * 64 + i % 32 * 2 + x];
      };
      light.values<double>()[i] = (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)) / 4;
    }
    OutputFormat output;
    output.maps_bounds = true;
    const ExposedPicture codes = rounded.render(functions, Mask::uniform(32, 32, 0), {}, output);
    most = std::max(most, share_of_map(codes, light, rounded.format(), "rounded"));
    ASSERT_FALSE(HasFailure());
    EXPECT_LE(term_of(codes, "rounded_codes").error->steps, 1.4 * 0.5);
    EXPECT_LE(most_of(codes, "rounded_codes"), 1.4 * 0.5);
    EXPECT_LE(codes.uncertainty.bounds.error->steps, 0.5 + 1.4 * 0.5 + 0.01);
    output = {ValueType::light64, 0};
    output.maps_bounds = true;
    const ExposedPicture floats = rounded.render(functions, Mask::uniform(32, 32, 0), {}, output);
    for (std::size_t i = 0; i < 32 * 32; ++i) {
      const double off = std::fabs(floats.picture.values<double>()[i] - light.values<double>()[i]);
      const double allowed = floats.bounds.front().values.values<float>()[i];
      ASSERT_LE(off, allowed) << "pixel " << i;
      of_light = std::max(of_light, off / allowed);
    }
  }
  std::printf("the largest share that rounded light used: %.3f of codes, %.3f of light\n", most, of_light);
  EXPECT_GT(most, 0.4);
  EXPECT_GT(of_light, 0.9);
}

// As a capture's file keeps it; `1` is what older ones say, if anything.
TEST(CodeRoundings, ComeBackFromTheirText) {
  CodeRoundings roundings;
  roundings.add(0.525, 1.0, "chroma");
  roundings.add(0.5, 3.0, "deflicker");
  EXPECT_DOUBLE_EQ(roundings.codes, 2.075);
  const CodeRoundings read = CodeRoundings::parse(roundings.text());
  EXPECT_GE(read.codes, roundings.codes);
  EXPECT_NEAR(read.codes, roundings.codes, 1e-6);
  EXPECT_EQ(read.unbounded, (std::vector<std::string>{"chroma", "deflicker"}));
  EXPECT_EQ(CodeRoundings::parse("1"), (CodeRoundings{0.5, {"unknown"}}));
  for (const char* damaged : {"", "x", "0,525000", "70000 x", "-1", "nan", "0.5x"})
    EXPECT_THROW(static_cast<void>(CodeRoundings::parse(damaged)), UsageError) << damaged;
}

}  // namespace
}  // namespace nutik::test
