// What a session answers, and what it refuses.
#include "session/session.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "capture/format.hpp"
#include "features/series/series_request.hpp"
#include "session/clips/encoding.hpp"
#include "session/uncertainty.hpp"
#include "support/clips.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"
#include "support/still_clip.hpp"
#include "support/tik_files.hpp"

namespace nutik::test {
namespace {

constexpr OutputFormat kFloats{ValueType::light32, 0};

ComputingRequest reference() {
  ComputingRequest request;
  request.renderer = RendererKind::reference;
  return request;
}

// 24 stills of 16 x 16 pixels, 100 a second.
class SessionOfClip : public ::testing::Test {
 protected:
  SessionOfClip() {
    use_modules();
    write_still_clip(scratch_.folder(), 16, 24);
    source_.path = scratch_ / "frames";
    source_.clip.rate = Rational{100, 1};
    request_.gains = PlainInterval{StatedTime::of_pictures(5), Shutter()};
    request_.start = StatedTime::of_pictures(3);
  }

  [[nodiscard]] Session forward() const {
    return {source_, std::make_shared<Devices>(reference()), {Reading::forward, {}, {}}};
  }

  Scratch scratch_;
  SourceRequest source_;
  ExposureRequest request_;
};

// By hand: five samples with a gain of 1 from picture 3 on, of which every other was made.
TEST_F(SessionOfClip, TellsWhatIsNoBoundByItsValues) {
  const ExposedPicture exposed = forward().render(request_, kFloats);
  CaptureErrors errors;
  errors.noise = LightCurve({{0.0, 0.01}, {1.0, 0.01}});
  errors.alignment_pixels = 0.25;
  errors.made = MadeSamples{std::vector<std::uint8_t>(12, 1)};
  const Uncertainty told = Uncertainty::of(exposed, errors);
  EXPECT_DOUBLE_EQ(told.scale, 1.0);
  const auto term = [&](std::string_view name) {
    const auto found = std::ranges::find(told.terms, name, &UncertaintyTerm::name);
    return found == told.terms.end() ? UncertaintyTerm() : *found;
  };
  using Figures = std::vector<std::pair<std::string_view, double>>;
  ASSERT_TRUE(term("noise").error);
  EXPECT_DOUBLE_EQ(term("noise").error->light, 0.01);
  EXPECT_DOUBLE_EQ(term("noise").error->steps, 0.01 * 0x1p23);
  EXPECT_EQ(term("noise").is, UncertaintyTerm::Is::deviation);
  EXPECT_EQ(term("alignment").figures, (Figures{{"residual_pixels", 0.25}}));
  EXPECT_EQ(term("made_samples").figures, (Figures{{"made_samples", 3}, {"exposed_samples", 5}}));
  EXPECT_EQ(term("made_samples").text, "3 of 5 samples were not filmed");
  EXPECT_LT(told.bounds.error->light, 1e-5) << "none of them is a bound";
}

// By hand, in linear light: a sensor's variance is read² + shot · light, and three deviations count as none.
TEST(Session, KnowsNoiseByItsModel) {
  CaptureFormat capture{.shape = {1, 1, 1}, .code_bytes = 2, .white_code = 65'535, .transfer = Transfer::linear()};
  capture.noise.camera = CameraNoise{4095, Transfer::linear(), {{NoiseCurve::sensor, 0.001, 1e-4, {}}}};
  const CaptureErrors errors = CaptureErrors::of(capture, {0.5});
  EXPECT_NEAR(errors.rounded.most(), 0.5 / 4095, 1e-9) << "of the clip's codes";
  const double at_white = std::sqrt(1e-6 + 1e-4);
  EXPECT_NEAR(errors.noise.most(), at_white, 0.01 * at_white) << "within a deviation of white";
  EXPECT_NEAR(errors.held.most(), 3 * at_white, 1e-3 * at_white) << "down from white";
  // By steep points: a code that is held in parts of the camera's may be off by what the camera's curve has there.
  const CameraNoise steep{255, Transfer::linear(), {{NoiseCurve::points, 0, 0, {{10, 0.5, 1}, {11, 8.0, 1}}}}};
  capture.noise.camera = steep;
  const LightCurve held = CaptureErrors::of(capture, {}).held;
  for (const double code : {10.1, 10.4, 10.6, 10.9})
    EXPECT_GE(held.at(code / 255) * (1 + 1e-9), 3 * steep.sd(0, code) / 255) << "code " << code;
  EXPECT_NEAR(CaptureErrors::of(capture, {}).noise.at(10.4 / 255), steep.sd(0, 10.4) / 255, 0.02 / 255);
  capture.noise.camera.reset();
  capture.noise.tolerance = 6;
  EXPECT_NEAR(CaptureErrors::of(capture, {}).held.most(), 6.0 / 65'535, 1e-15);
  EXPECT_NEAR(CaptureErrors::of(capture, {0.5}).rounded.most(), 0.5 / 65'535, 1e-15);
  EXPECT_TRUE(CaptureErrors::of(capture, {0.5}).noise.is_zero());
}

// The curve bends down, lies below nothing that a sample may be off by, and of powers is that itself: means of samples
// are off by as many codes as each of them.
TEST_F(SessionOfClip, WhatIsHeldOfTheDarkIsHeldCloser) {
  CaptureFormat capture{.shape = {1, 1, 1}};
  for (const char* name : {"srgb", "bt709", "gamma:2.2", "gamma:0.5", "linear", "hlg", "pq", "slog3"}) {
    capture.transfer = Transfer::parse(name);
    for (const std::uint32_t tolerance : {1u, 4u, 100u}) {
      capture.noise.tolerance = tolerance;
      const LightCurve held = CaptureErrors::of(capture, {}).held;
      const auto light = [&](double code) { return capture.transfer.light_of(std::clamp(code / 255, 0.0, 1.0)); };
      for (int code = 0; code < 256; ++code) {
        const double up = light(code + tolerance) - light(code), down = light(code) - light(code - int(tolerance));
        EXPECT_GE(held.at(light(code)) * (1 + 1e-12), std::max(up, down)) << name << ", code " << code;
        if (name == std::string("gamma:2.2") && code + tolerance < 256) {
          EXPECT_NEAR(held.at(light(code)), up, 0.02 * up) << "code " << code;
        }
      }
      for (std::size_t i = 2; i < held.points().size(); ++i) {
        const auto [a, b, c] = std::tuple(held.points()[i - 2], held.points()[i - 1], held.points()[i]);
        EXPECT_GE((b.off - a.off) / (b.light - a.light) * (1 + 1e-9) + 1e-12, (c.off - b.off) / (c.light - b.light))
            << name << " at " << i;
      }
      EXPECT_EQ(held.most(0.0, 1.0), held.most());
      EXPECT_LE(held.most(0.0, 0.1), held.most());
    }
  }
}

TEST_F(SessionOfClip, AnswersTheSameReadForwardAndWhole) {
  Session once = forward();
  EXPECT_TRUE(once.is_clip());
  EXPECT_EQ(once.timeline().sample_count(), 24u);
  const ExposedPicture streamed = once.render(request_, kFloats);
  Session whole(source_, reference());
  for (int k = 0; k < 2; ++k) {
    const ExposedPicture again = whole.render(request_, kFloats);
    EXPECT_EQ(again.picture.bytes, streamed.picture.bytes);
    EXPECT_EQ(again.figures.live_samples, streamed.figures.live_samples);
  }
  EXPECT_EQ(streamed.figures.timeline.sample_count(), 24u);
  EXPECT_FALSE(streamed.figures.block_count.has_value());
}

// Means of two codes in turns are ties.
TEST_F(SessionOfClip, InWholeNumbersOrEqualBlocksIsTheSameReadForwardAndWhole) {
  source_.path = scratch_ / "ties";
  std::filesystem::create_directory(source_.path);
  for (int k = 0; k < 40; ++k) {
    std::string file = "P5 32 8 255\n";
    for (int pixel = 0; pixel < 256; ++pixel) file += static_cast<char>(pixel % 10 + (k + pixel / 32) % 2);
    scratch_.write(format("ties/{:02}.pgm", k), file);
  }
  request_.gains = PlainInterval{StatedTime::of_pictures(34), Shutter()};
  const auto codes = [&](Reading reading, std::uint32_t block_samples, Precision precision) {
    source_.block_samples = block_samples;
    ComputingRequest computing;
    computing.precision = precision;
    Session session(source_, std::make_shared<Devices>(computing), {reading, {}, {}});
    OutputFormat output;
    output.transfer = Transfer::srgb();
    return session.render(request_, output).picture.bytes;
  };
  EXPECT_EQ(codes(Reading::forward, 7, Precision::fixed), codes(Reading::whole, 40, Precision::fixed));
  EXPECT_EQ(codes(Reading::forward, 7, Precision::single_), codes(Reading::whole, 7, Precision::single_));
}

// Rice's codes alone count the steps of a tolerance: no codec packs worse than these, and all are read.
TEST_F(SessionOfClip, WithAToleranceEveryCodecPacksAsWellAsRices) {
  source_.path = scratch_ / "noise";
  std::filesystem::create_directory(source_.path);
  Random random(3);
  for (int k = 0; k < 20; ++k) {
    std::string file = "P5 64 64 255\n";
    for (int pixel = 0; pixel < 64 * 64; ++pixel) file += static_cast<char>(random.whole(90, 110) + pixel % 64);
    scratch_.write(format("noise/{:02}.pgm", k), file);
  }
  const auto bytes_of = [&](const std::string& codec, std::uint32_t tolerance) {
    source_.tolerance = tolerance;
    const std::filesystem::path output = scratch_ / format("{}{}.tik", codec, tolerance);
    const auto encoded = encode(source_, {output, tik::Codec::parse(codec)}, MemoryBudget::of_machine());
    EXPECT_EQ(Session({.path = output}, reference()).compare_with(source_).comparison.values_beyond(), 0u) << codec;
    return encoded.file_bytes;
  };
  for (const std::uint32_t tolerance : {1u, 4u}) {
    const std::uint64_t rice = bytes_of("rice", tolerance);
    for (const char* codec : {"lz4", "zstd"}) EXPECT_LE(bytes_of(codec, tolerance), rice) << codec;
  }
  EXPECT_LT(bytes_of("lz4", 4), 3 * bytes_of("lz4", 0) / 4);
}

TEST_F(SessionOfClip, ReadsAClipThatItsOwnerMakes) {
  int opened = 0;
  Session::Terms terms;
  terms.open_clip = [&] {
    ++opened;
    return open_clip(scratch_ / "frames", source_.clip);
  };
  SourceRequest source = source_;
  source.path = "pictures";  // its name alone: no such file is there
  const auto devices = std::make_shared<Devices>(reference());
  Session session(source, devices, terms);
  EXPECT_EQ(opened, 1);
  EXPECT_TRUE(session.is_clip());
  EXPECT_EQ(session.render(request_, kFloats).picture,
            Session(source_, devices).render(request_, kFloats).picture);

  terms.reading = Reading::forward;
  EXPECT_EQ(message_of<UsageError>([&] { Session(source, devices, terms); }),
            "a clip that its owner makes is read whole");
  source.path.clear();
  terms.reading = Reading::whole;
  EXPECT_EQ(message_of<UsageError>([&] { Session(source, devices, terms); }), "no clip is named");
}

TEST_F(SessionOfClip, ReadForwardIsSpentAfterOnePicture) {
  Session once = forward();
  EXPECT_THROW(static_cast<void>(once.capture()), SessionIsSpent);
  EXPECT_THROW(static_cast<void>(once.trace(request_, TracedPixel{0, 0})), SessionIsSpent);
  EXPECT_EQ(once.render(request_, kFloats).picture.shape, (Shape{16, 16, 1}));
  EXPECT_THROW(static_cast<void>(once.render(request_, kFloats)), SessionIsSpent);
}

// Whole numbers hold light in 30 bits, of which the darkest codes of PQ in 16 bits share one.
TEST_F(SessionOfClip, DoubtsAnArithmeticThatIsAskedForAndTooCoarse) {
  source_.clip.transfer = Transfer::pq();
  const OutputFormat codes8{ValueType::code8, 255}, codes16{ValueType::code16, 65535};
  ComputingRequest fixed;
  fixed.precision = Precision::fixed;
  Session session(source_, fixed);
  const std::vector<std::string> warnings = session.render(request_, codes16).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(warnings[0].starts_with("fixed is not sure to be right to 0.5 of a code here: light within "))
      << warnings[0];
  EXPECT_TRUE(warnings[0].ends_with("; auto takes an arithmetic that is sure, where there is one")) << warnings[0];
  EXPECT_TRUE(session.render(request_, codes8).warnings.empty());
  EXPECT_TRUE(session.render(request_, kFloats).warnings.empty());
  EXPECT_TRUE(Session(source_, ComputingRequest()).render(request_, codes16).warnings.empty());
  RenderControl control{.precision = Precision::fixed};
  EXPECT_EQ(session.render(request_, codes16, control).warnings, warnings);
  control.is_chosen = true;  // by a program
  EXPECT_TRUE(session.render(request_, codes16, control).warnings.empty());
}

// Whoever made a request: what the command line refuses is refused here, and nothing is written.
TEST_F(SessionOfClip, RefusesWhatNoRequestMayBe) {
  Session session(source_, reference());
  ExposureRequest functions = request_;
  functions.gains = Shared(FunctionSet{{7, GainFunction({{0, 1.0}})}, {9, GainFunction({{0, 1.0}})}});
  EXPECT_EQ(message_of<UsageError>([&] { return session.render(functions, kFloats); }),
            "there are 2 gain functions; a mask says where each applies");
  functions.gains = Shared(FunctionSet{});
  EXPECT_EQ(message_of<UsageError>([&] { return session.render(functions, kFloats); }),
            "an exposure needs a gain function");
  ExposureRequest masked = request_;
  masked.mask = Shared(MaskWithRegions(Mask{16, 16, {0, 0, 0}}));
  EXPECT_EQ(message_of<InputError>([&] { return session.render(masked, kFloats); }),
            "the mask is 16 x 16 pixels and has 3 tags; each pixel needs one");
  for (const auto& [type, white] : {std::pair(ValueType::code8, 256u), std::pair(ValueType::code8, 0u),
                                    std::pair(ValueType::code16, 65'536u)}) {
    EXPECT_THROW(static_cast<void>(session.render(request_, {type, white})), UsageError) << white;
  }
  EXPECT_THROW(static_cast<void>(session.render(request_, kFloats, {.memory_bytes = 1})), MemoryTooLittle);
  EXPECT_THROW(static_cast<void>(session.validate(request_, kFloats, 0)), UsageError);
  EXPECT_THROW(Session(source_, std::shared_ptr<Devices>()), UsageError);
  SeriesRequest series;
  series.every = StatedTime::parse("0s", "every");
  EXPECT_THROW(static_cast<void>(starts_of(series, request_, session.timeline())), UsageError);

  SourceRequest noisy = source_;
  noisy.noise = NoiseOfClip();
  noisy.sigmas = -1;
  EXPECT_EQ(message_of<UsageError>([&] { return Session(noisy, reference()); }),
            "-1 standard deviations of noise are not within 0.1 … 100");
  const std::filesystem::path still = *std::filesystem::directory_iterator(scratch_ / "frames");
  const std::string bytes = read_file(still);
  EncodeRequest onto;
  onto.output = still;
  EXPECT_THROW(static_cast<void>(encode(source_, onto, MemoryBudget::of_machine())), UsageError);
  EXPECT_EQ(read_file(still), bytes);
}

TEST_F(SessionOfClip, IsNotOpenedWhenNobodyWantsItAnyMore) {
  std::stop_source stop;
  std::uint64_t told = 0;
  const ReportedProgress progress = [&](std::uint64_t done, std::uint64_t total) {
    EXPECT_EQ(total, 24u);
    told = done;
    stop.request_stop();
  };
  EXPECT_THROW(
      Session(source_, std::make_shared<Devices>(reference()), {Reading::whole, progress, stop.get_token()}),
      Cancelled);
  EXPECT_GT(told, 0u);
  EXPECT_LT(told, 24u);
}

TEST_F(SessionOfClip, StopsBetweenPicturesOfOnePass) {
  Session session(source_);
  std::stop_source stop;
  std::uint64_t told = 0;
  std::size_t made = 0;
  RenderControl control{.stop = stop.get_token(), .progress = [&](std::uint64_t done, std::uint64_t) { told = done; }};
  EXPECT_THROW(session.render_many(std::vector(5, request_), kFloats, control,
                                   [&](std::size_t, const ExposedPicture&) {
                                     ++made;
                                     stop.request_stop();
                                   }),
               Cancelled);
  EXPECT_EQ(made, 1u);
  EXPECT_GT(told, 0u);
}

TEST_F(SessionOfClip, TracesAPixelToItsLight) {
  Session session(source_, reference());
  const ExposedPicture exposed = session.render(request_, {ValueType::light64, 0});
  const TracedExposure traced = session.trace(request_, TracedPixel{4, 5});
  EXPECT_EQ(traced.traces.at(0).light[0], exposed.picture.values<double>()[5 * 16 + 4]);
  EXPECT_EQ(traced.figures.live_samples, exposed.figures.live_samples);
}

TEST_F(SessionOfClip, IsComparedWithItsClip) {
  Session session(source_, reference());
  const SourceCheck check = session.compare_with(source_);
  EXPECT_EQ(check.comparison.values_beyond(), 0u);
  EXPECT_FALSE(check.clip_goes_on);
}

TEST(Session, RefusesADescriptionOfWhatWasDescribed) {
  const Scratch scratch;
  SourceRequest source{.path = write_tik(RandomCase(3), {tik::CodecId::none, 0}, scratch)};
  EXPECT_FALSE(source.describes_clip());
  source.clip.transfer = Transfer::linear();
  EXPECT_FALSE(source.describes_clip()) << "an exposure may take codes for other light";
  source.tolerance = 1;
  EXPECT_TRUE(source.describes_clip());
  EXPECT_EQ(message_of<UsageError>([&] { Session(source, reference()); }),
            "what is stated describes a clip that is encoded; " + source.path.string() + " was encoded already");
}

TEST(Session, SaysWhichDevicesThereAre) {
  ComputingRequest computing;
  computing.device = "no such device";
  Devices devices(computing);
  std::vector<std::string> parts{"no such device"};
  for (const DeviceInfo& device : list_devices()) parts.push_back(device.name);
  expect_error<DeviceError>([&] { static_cast<void>(devices.renderer()); }, parts);
}

TEST(Session, ValidatesWithOpenClOnly) {
  Devices devices(reference());
  EXPECT_THROW(static_cast<void>(devices.opencl()), UsageError);
}

}  // namespace
}  // namespace nutik::test
