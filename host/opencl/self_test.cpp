#include "opencl/self_test.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include "capture/format.hpp"
#include "opencl/kernel_numbers.hpp"
#include "render/combining_renderer.hpp"
#include "render/picture_errors.hpp"
#include "render/reference_renderer.hpp"

namespace nutik {
namespace {

constexpr OutputFormat kLight{ValueType::light64, 0};

using Rasters = std::vector<std::vector<std::byte>>;

// Numbers in no order, the same everywhere.
std::uint32_t mixed(std::uint32_t number) {
  number = (number ^ (number >> 16)) * 0x7feb352du;
  number = (number ^ (number >> 15)) * 0x846ca68bu;
  return number ^ (number >> 16);
}

void set_code(const CaptureFormat& capture, std::vector<std::byte>& raster, std::uint64_t value,
              std::uint32_t code) {
  std::memcpy(raster.data() + value * capture.code_bytes, &code, capture.code_bytes);  // little-endian
}

CaptureFormat format_like(const CaptureFormat& like, std::uint32_t width, std::uint32_t height) {
  CaptureFormat capture = like;
  capture.shape.width = width;
  capture.shape.height = height;
  capture.noise = {};
  return capture;
}

// How often a pixel has changed until a sample, by the kind of its tile: still, rows, dense, records.
std::uint32_t changes_until(std::uint32_t sample, std::uint32_t kind, std::uint32_t pixel) {
  constexpr std::uint32_t kRowTimes[]{37, 38, 100, 259, 270};
  constexpr std::uint32_t kRecordPeriod = 61;
  switch (kind) {
    case 0: return 0;
    case 1:
      return static_cast<std::uint32_t>(
          std::ranges::count_if(kRowTimes, [&](auto time) { return time <= sample; }));
    case 2: return sample;
    default: return (sample + mixed(pixel) % kRecordPeriod) / kRecordPeriod;
  }
}

class TilesOfAllKinds {
 public:
  explicit TilesOfAllKinds(const CaptureFormat& like)
      : format_(format_like(like, 5 * kTileSide + 3, 3 * kTileSide + 5)) {}

  [[nodiscard]] MemoryCapture capture() const {
    const Shape& shape = format_.shape;
    Rasters rasters(kSamples, std::vector<std::byte>(format_.sample_bytes()));
    for (std::uint32_t sample = 0; sample < kSamples; ++sample) {
      for (std::uint32_t pixel = 0; pixel < shape.pixel_count(); ++pixel) {
        const std::uint32_t x = pixel % shape.width, y = pixel / shape.width;
        const std::uint32_t changes = changes_until(sample, (x / kTileSide + y / kTileSide) % 4, pixel);
        for (std::uint32_t channel = 0; channel < shape.channels; ++channel) {
          const std::uint64_t value = std::uint64_t{pixel} * shape.channels + channel;
          const std::uint32_t number = mixed(changes * 0x9e3779b9u + static_cast<std::uint32_t>(value));
          set_code(format_, rasters[sample], value, number % (format_.white_code + 1));
        }
      }
    }
    // Blocks of 260 samples and of 40.
    return {format_, Timeline::constant({1000, 1}, {180, 1}, kSamples), rasters, 260};
  }

  // One function a tile; in the second row of tiles all of them, pixel by pixel. A soft one mixes two or three of them
  // in that row and in the last.
  [[nodiscard]] Mask mask(bool is_soft) const {
    const Shape& shape = format_.shape;
    Mask mask = Mask::uniform(shape.width, shape.height, 0);
    for (std::uint32_t pixel = 0; pixel < shape.pixel_count(); ++pixel) {
      const std::uint32_t x = pixel % shape.width, y = pixel / shape.width;
      const bool is_mixed = y / kTileSide == 1;
      mask.tags[pixel] = static_cast<std::uint8_t>(is_mixed ? (x + y) % 4 : x / kTileSide % 3);
      if (is_soft && y / kTileSide % 2 == 1 && mixed(pixel) % 3 > 0) mix(mask, pixel);
    }
    return mask;
  }

  // They have the same times, and gains that differ or one gain each.
  [[nodiscard]] static FunctionSet functions_to_combine(bool scale) {
    if (scale) {
      FunctionSet differing = functions(0.25);
      differing.at(0) = GainFunction({{0, 1.0}, {300'000'000, 0.0}});
      return differing;
    }
    return {{0, GainFunction({{0, 1.0}})},
            {1, GainFunction::boxcar(271'300'000, 292'700'000, 14.0)},
            {2, GainFunction::boxcar(20'000'000, 290'000'000, 0.7)},
            {3, GainFunction::boxcar(0, 261'000'000)}};
  }

  // One for each row: more pairs with a function than a byte counts, and tiles with one delay and with several.
  [[nodiscard]] DelayMap delays() const {
    return DelayMap::by_rows(format_.shape, {-11'000'000, 17'000'000});
  }

  // All the time; only within the last block; with a gain that may be negative; much weaker than the others.
  [[nodiscard]] static FunctionSet functions(double early_gain) {
    constexpr std::int64_t kMs = 1'000'000;
    return {{0, GainFunction({{0, 1.0}})},
            {1, GainFunction::boxcar(271'300'000, 292'700'000, 14.0)},
            {2, GainFunction(
                    {{0, early_gain}, {50 * kMs, 0.0}, {150 * kMs, 5.0}, {151 * kMs, 0.0}, {300 * kMs, 0.01}})},
            {3, GainFunction({{0, 1.0 / 3000}, {300 * kMs, 1.0 / 5000}})}};
  }

 private:
  // Shares of the functions behind the first, of any size; the tag keeps the largest.
  static void mix(Mask& mask, std::uint32_t pixel) {
    const auto small = static_cast<std::uint16_t>(1 + mixed(pixel + 1) % 20'000);
    const auto smaller = static_cast<std::uint16_t>(1 + mixed(pixel + 2) % 10'000);
    const auto most = static_cast<std::uint16_t>(kWholeShare - small - smaller);
    mask.mixed.add(
        pixel, pixel % 2 == 0
                   ? std::vector<Share>{{0, most}, {1, small}, {2, smaller}}
                   : std::vector<Share>{{1, small}, {3, static_cast<std::uint16_t>(kWholeShare - small)}});
    mask.tags[pixel] = pixel % 2 == 0 ? 0 : 3;
  }

  static constexpr std::uint32_t kSamples = 300;

  CaptureFormat format_;
};

// One pixel that changes at each of more samples than 16 bits count, in many blocks.
MemoryCapture long_capture(const CaptureFormat& like) {
  constexpr std::uint32_t kSamples = 66'000;
  const CaptureFormat capture = format_like(like, 1, 1);
  Rasters rasters(kSamples, std::vector<std::byte>(capture.sample_bytes()));
  for (std::uint32_t sample = 0; sample < kSamples; ++sample) {
    for (std::uint32_t channel = 0; channel < capture.shape.channels; ++channel) {
      set_code(capture, rasters[sample], channel, mixed(sample * 3 + channel) % (capture.white_code + 1));
    }
  }
  return {capture, Timeline::constant({1000, 1}, Timeline::kFullShutter, kSamples), rasters,
          kDefaultBlockSamples, TilePolicy::dense};
}

}  // namespace

std::string fault_text(const Verdict& verdict) {
  if (verdict.light_error > verdict.allowed_error || verdict.wrong_codes == 0) {
    return format("light is wrong by {:.1g} instead of {:.1g}", verdict.light_error, verdict.allowed_error);
  }
  return format("{} of {} codes are wrong", verdict.wrong_codes, verdict.codes);
}

Verdict self_test(const CaptureFormat& like, Precision precision, const OutputFormat& output,
                  const TestedPixels& pixels, const RenderScene& render) {
  Verdict verdict;
  LightErrors worst;
  ReferenceRenderer reference;
  const auto judge = [&](CaptureSource& capture, const RenderPlan& plan, bool with_codes) {
    OutputFormat codes = output;
    codes.negative = NegativeLight::saturate;
    const ErrorBound bound = error_bound(plan, precision, with_codes ? codes : kLight);
    const Picture expected = reference.render(plan, capture, kLight).picture;
    const LightErrors light = light_errors(plan, bound, expected, render(plan, capture, kLight));
    if (light.share_of_bound > worst.share_of_bound) worst = light;
    if (!with_codes) return;
    const StoredErrors stored = stored_errors(plan, bound, expected, render(plan, capture, codes));
    verdict.codes = stored.values;
    verdict.wrong_codes = stored.differing - stored.explained;
  };
  MemoryCapture endless = long_capture(like);
  PlanOptions options;
  if (pixels.have_delays) {
    options.delays = std::make_shared<const DelayMap>(DelayMap::by_rows(endless.format().shape, {0, 0}));
  }
  judge(endless, make_plan(endless, {{0, GainFunction({{0, 1.0}})}}, Mask::uniform(1, 1, 0), options), false);
  const TilesOfAllKinds scene(like);
  MemoryCapture tiles = scene.capture();
  if (pixels.have_delays) options.delays = std::make_shared<const DelayMap>(scene.delays());
  judge(tiles, make_plan(tiles, TilesOfAllKinds::functions(-0.25), scene.mask(pixels.share_functions), options),
        kernels_make_codes(like, output));
  verdict.light_error = worst.bounded_error;
  verdict.allowed_error = worst.bound;
  verdict.is_right = worst.share_of_bound <= 1.0 && verdict.wrong_codes == 0;
  return verdict;
}

Verdict self_test_combining(const RenderPlan& like, bool scales, const RenderScene& render) {
  Verdict verdict;
  PlanOptions options;
  options.combine = like.combine;
  const auto judge = [&](CaptureSource& capture, const FunctionSet& functions, const Mask& mask) {
    const RenderPlan plan = make_plan(capture, functions, mask, options);
    const Picture expected = CombiningRenderer().render(plan, capture, kLight).picture;
    const Picture light = render(plan, capture, kLight);
    verdict.codes += light.shape.value_count();
    for (std::size_t i = 0; i < light.shape.value_count(); ++i)
      verdict.wrong_codes += expected.values<double>()[i] != light.values<double>()[i];
  };
  MemoryCapture endless = long_capture(like.capture);
  judge(endless, {{0, GainFunction({{0, 1.0}, {66'000'000'000, scales ? 0.5 : 1.0}})}}, Mask::uniform(1, 1, 0));
  const TilesOfAllKinds scene(like.capture);
  MemoryCapture tiles = scene.capture();
  judge(tiles, TilesOfAllKinds::functions_to_combine(scales), scene.mask(true));
  verdict.is_right = verdict.wrong_codes == 0;
  return verdict;
}

}  // namespace nutik
