#include "noise/noise_estimator.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "capture/format.hpp"
#include "capture/median.hpp"
#include "capture/text.hpp"
#include "system/parallel.hpp"

namespace nutik {
namespace {

constexpr int kFitPasses = 30;
constexpr double kHuber = 2.0;        // uncertainties up to which a point has its full say
constexpr double kModelError = 0.01;  // share of sd to which no camera follows the model

struct LightPoint {
  double light;
  double variance;        // in light
  double relative_error;  // of the variance
};

struct Line {
  double constant = 0;
  double slope = 0;
};

Line weighted_line(std::span<const LightPoint> points, std::span<const double> weights) {
  double w = 0, wl = 0, wll = 0, wv = 0, wlv = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [light, variance, error] = points[i];
    w += weights[i];
    wl += weights[i] * light;
    wll += weights[i] * light * light;
    wv += weights[i] * variance;
    wlv += weights[i] * light * variance;
  }
  const double determinant = w * wll - wl * wl;
  // Points at one light say nothing of the slope; what grows with the light is the usual case.
  const Line only_slope{0, wll > 0 ? wlv / wll : 0}, only_constant{wv / w, 0};
  if (determinant <= 1e-9 * w * wll) return wll > 0 ? only_slope : only_constant;
  const Line line{(wll * wv - wl * wlv) / determinant, (w * wlv - wl * wv) / determinant};
  if (line.constant < 0) return only_slope;
  if (line.slope < 0) return only_constant;
  return line;
}

constexpr std::size_t kMaxKept = 2 << 20;  // pixels of a channel
constexpr double kGroups = 48;              // that the range of codes is cut into
constexpr std::size_t kGroupPixels = 512;   // or more, where codes are frequent
constexpr std::size_t kMinGroupPixels = 64;
constexpr double kSparseWidth = 3;    // group widths that rare codes may be spread over
constexpr double kRangeTail = 0.001;  // pixels at either end that do not make the range
constexpr int kPasses = 50;           // they settle after a few
constexpr double kOutlier = 3.0;      // standard deviations of a variance's distribution
constexpr double kClipping = 3.0;  // standard deviations from black and white within which codes are cut off
constexpr double kJoinedWidth = 0.5;  // group widths within which points of several clips are one
constexpr double kTold =
    1.0;  // variance from which on rounding to codes does not make pixels stray unlike each other
constexpr double kUneven = 0.25;         // standard deviation of the pixels' own variances, of their mean
constexpr double kMinDistance = 1e-5;  // of points, in white codes: six digits tell them apart
constexpr double kLargestMisfit = 0.04;
constexpr double kWorstMisfit = 0.10;

// Quantile of a variance with so many degrees of freedom, as a multiple of its expectation, at z standard
// deviations of the normal distribution (Wilson and Hilferty 1931; within 5 % for one degree, 1 % from four on).
double variance_quantile(double degrees, double z) {
  return std::pow(1 - 2 / (9 * degrees) + z * std::sqrt(2 / (9 * degrees)), 3);
}

struct StillPixels {
  double variance = 0;
  double code = 0;
  std::uint64_t count = 0;
  double beside = 0, below = 0;  // sums
};

// Whether pixels' variances lie further apart than those of one noise do when each is measured with so many degrees of
// freedom: by 2 / degrees of their mean's square, and how far that is off of so many pixels follows from the fourth
// moment of chi-squared. Each place of a mosaic has a noise of its own.
bool is_uneven(std::span<const PixelNoise> group, const StillPixels& still, double degrees) {
  struct Place {
    double count = 0, sum = 0, squares = 0;
  };
  const double limit = variance_quantile(degrees, kOutlier) * still.variance;
  std::array<Place, kMosaicPlaces> places;
  for (const PixelNoise& pixel : group) {
    if (pixel.variance > limit) continue;
    auto& [count, sum, squares] = places[pixel.place];
    count += 1;
    sum += pixel.variance;
    squares += double{pixel.variance} * pixel.variance;
  }
  double spread = 0;
  for (const auto& [count, sum, squares] : places) {
    if (count > 0) spread += count * (squares * count / (sum * sum) - 1);
  }
  const auto count = static_cast<double>(still.count);
  const double of_noise = 2 / degrees, uncertainty = of_noise * std::sqrt((2 + 12 / degrees) / count);
  return spread / count > of_noise + kUneven * kUneven + kOutlier * uncertainty;
}

// The mean variance of pixels that vary alike, without those that vary far more: from their median on, the
// limit and the mean are found in turn. Rounding alone makes variances of up to kRoundingVariance and more, in
// pixels that happen to lie between two codes.
StillPixels still_pixels(std::span<const PixelNoise> group, double degrees) {
  std::vector<float> variances;
  for (const PixelNoise& pixel : group) variances.push_back(pixel.variance);
  StillPixels still{median(std::move(variances)) / variance_quantile(degrees, 0), 0, 0};
  const double outlier = variance_quantile(degrees, kOutlier);
  for (int pass = 0; pass < kPasses; ++pass) {
    const std::uint64_t before = still.count;
    const double limit = outlier * std::max(still.variance, kRoundingVariance);
    double sum = 0, codes = 0;
    still.beside = still.below = 0;
    still.count = 0;
    for (const PixelNoise& pixel : group) {
      if (pixel.variance > limit) continue;
      sum += pixel.variance;
      codes += pixel.code;
      still.beside += pixel.beside;
      still.below += pixel.below;
      ++still.count;
    }
    if (still.count == 0) return still;
    still.variance = sum / static_cast<double>(still.count);
    still.code = codes / static_cast<double>(still.count);
    if (still.count == before) break;
  }
  return still;
}

double six_digits(double value) { return parsed<double>(format("{:.6g}", value)).value_or(value); }

// Points of several clips that lie close together become one.
std::vector<MeasuredPoint> joined(std::vector<MeasuredPoint> points, std::uint32_t white_code) {
  std::ranges::sort(points, {}, [](const MeasuredPoint& each) { return each.point.code; });
  const double low = points.front().point.code;
  const double range = std::max(points.back().point.code - low, kMinDistance * white_code);
  const auto place = [&](const MeasuredPoint& each) {
    return std::sqrt((each.point.code - low) / range) * kGroups;
  };
  std::vector<MeasuredPoint> few;
  for (const MeasuredPoint& each : points) {
    const bool is_far =
        few.empty() || (place(each) - place(few.back()) > kJoinedWidth &&
                        each.point.code - few.back().point.code > kMinDistance * white_code);
    if (is_far) {
      few.push_back(each);
      continue;
    }
    auto& [last, last_uncertainty] = few.back();
    const double a = std::pow(last_uncertainty, -2), b = std::pow(each.uncertainty, -2);
    last.code = (a * last.code + b * each.point.code) / (a + b);
    last.sd = std::sqrt((a * last.sd * last.sd + b * each.point.sd * each.point.sd) / (a + b));
    last.pixels += each.point.pixels;
    last_uncertainty = 1 / std::sqrt(a + b);
  }
  return few;
}

// Pixels of a channel that are kept of so many samples.
std::uint64_t max_kept(const Shape& shape, std::uint64_t max_samples) {
  const std::uint64_t windows = max_samples / kWindowSamples + 1;
  return std::min<std::uint64_t>(kMaxKept, windows * StillWindow::pixel_count(shape));
}

}  // namespace

SensorFit fit_sensor(std::span<const MeasuredPoint> points, std::uint32_t white_code,
                     const Transfer& transfer) {
  std::vector<LightPoint> in_light;
  std::vector<double> weights;
  for (const auto& [point, uncertainty] : points) {
    const double sd = light_sd_of(point.sd, point.code, white_code, transfer);
    // Rounding is known: what is left when it is taken away has all of the error.
    const double of_light = point.sd * point.sd - kRoundingVariance;
    const double share = std::max(of_light / (point.sd * point.sd), 0.01);
    const double error = 2 * std::hypot(uncertainty, kModelError) / share;
    in_light.push_back({transfer.light_of(point.code / white_code), sd * sd, error});
    weights.push_back(sd > 0 ? 1 / (error * error * sd * sd * sd * sd) : 0);
  }
  if (*std::ranges::max_element(weights) == 0) weights.assign(weights.size(), 1);  // no noise anywhere
  Line line;
  for (int pass = 0; pass < kFitPasses; ++pass) {
    line = weighted_line(in_light, weights);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const double expected = line.constant + line.slope * in_light[i].light;
      const double error = in_light[i].relative_error * expected;
      if (error <= 0) continue;
      const double distance = std::abs(in_light[i].variance - expected) / error;
      weights[i] = std::min(1.0, kHuber / std::max(distance, kHuber)) / (error * error);
    }
  }
  SensorFit fit{std::sqrt(line.constant), line.slope, 0, 0};
  std::vector<double> deviations;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const NoisePoint& point = points[i].point;
    const double light_sd = std::sqrt(line.constant + line.slope * in_light[i].light);
    deviations.push_back(std::abs(code_sd_of(light_sd, point.code, white_code, transfer) / point.sd - 1));
  }
  std::ranges::sort(deviations);
  deviations.resize(deviations.size() - deviations.size() / 4);
  fit.worst = deviations.back();
  for (const double deviation : deviations) fit.misfit += deviation * deviation;
  fit.misfit = std::sqrt(fit.misfit / static_cast<double>(deviations.size()));
  return fit;
}

NoiseEstimator::NoiseEstimator(const CaptureFormat& capture, std::uint32_t threads)
    : capture_(capture), threads_(threads), channels_(capture.shape.channels) {}

MemoryNeeds NoiseEstimator::needs(const CaptureFormat& capture, std::uint64_t max_samples) {
  const Shape& shape = capture.shape;
  const std::uint64_t kept = max_kept(shape, max_samples);
  // Kept are those of each channel; of one they are looked at in the end, beside their variances.
  return {{"a picture", capture.sample_bytes()},
          {"pictures that noise is measured on", StillWindow::window_bytes(shape)},
          {"measuring the noise", StillWindow::measuring_bytes(shape)},
          {"noise of pixels", kept * (shape.channels * sizeof(PixelNoise) + sizeof(float))}};
}

std::uint32_t NoiseEstimator::threads_in(std::uint64_t bytes, const CaptureFormat& capture,
                                         std::uint64_t max_samples) {
  const std::uint64_t rest = needs(capture, max_samples).rest_of(bytes);
  return static_cast<std::uint32_t>(
      1 +
      std::min<std::uint64_t>(rest / StillWindow::measuring_bytes(capture.shape), capture.shape.channels));
}

void NoiseEstimator::Pixels::add(std::span<const PixelNoise> pixels) {
  for (const PixelNoise& pixel : pixels) {
    if (seen++ % stride != 0) continue;
    kept.push_back(pixel);
    if (kept.size() < kMaxKept) continue;
    for (std::size_t i = 0; i < kept.size() / 2; ++i) kept[i] = kept[2 * i];
    kept.resize(kept.size() / 2);
    stride *= 2;
  }
}

void NoiseEstimator::add_clip(const std::string& name, const ReadSample& read_sample,
                              std::uint64_t max_samples) {
  std::vector<Pixels> pixels(channels_.size());
  for (Pixels& channel : pixels) channel.kept.reserve(max_kept(capture_.shape, max_samples));
  std::vector<std::byte> raster(capture_.sample_bytes());
  StillWindow window(capture_);
  std::uint64_t samples = 0;
  const auto measure = [&] {
    parallel_for(
        channels_.size(),
        [&](std::uint64_t channel) {
          pixels[channel].add(window.measure(static_cast<std::uint32_t>(channel)));
        },
        threads_);
  };
  while (samples < max_samples && read_sample(raster)) {
    ++samples;
    window.add(raster);
    if (!window.is_full()) continue;
    measure();
    window.clear();
  }
  if (samples < kMinWindowSamples) {
    throw UnknownNoise(format("{}: {} picture{} of a still scene; noise is measured on {} or more", name,
                              samples, samples == 1 ? "" : "s", kMinWindowSamples));
  }
  // A rest that is shorter than a window would be less sure of itself than what is there already.
  if (samples < kWindowSamples) measure();
  sample_count_ += samples;
  const double degrees = StillWindow::degrees_of_freedom(
      static_cast<std::uint32_t>(std::min<std::uint64_t>(samples, kWindowSamples)));
  for (std::uint32_t channel = 0; channel < channels_.size(); ++channel) {
    add_points(channels_[channel], std::move(pixels[channel].kept), degrees);
  }
}

void NoiseEstimator::add_points(ChannelPoints& channel, std::vector<PixelNoise> pixels,
                                double degrees) const {
  std::ranges::sort(pixels, {}, &PixelNoise::code);
  const auto tail = static_cast<std::size_t>(kRangeTail * static_cast<double>(pixels.size()));
  const double low = pixels[tail].code;
  const double range =
      std::max(pixels[pixels.size() - 1 - tail].code - low, kMinDistance * capture_.white_code);
  const auto place = [&](const PixelNoise& pixel) {
    return std::sqrt(std::max(pixel.code - low, 0.0) / range) * kGroups;
  };
  channel.pixels += pixels.size();
  std::size_t begin = 0;
  const auto close = [&](std::size_t end) {
    const std::span<const PixelNoise> group(pixels.data() + begin, end - begin);
    begin = end;
    const StillPixels still = still_pixels(group, degrees);
    if (still.count == 0) return;
    channel.still_pixels += still.count;
    channel.variance += static_cast<double>(still.count) * std::max(still.variance, kRoundingVariance);
    channel.beside += still.beside;
    channel.below += still.below;
    const double uncertainty = 1 / std::sqrt(2.0 * degrees * static_cast<double>(still.count));
    if (still.variance >= kTold) {
      ++channel.told;
      channel.uneven += is_uneven(group, still, degrees);
    }
    const double sd = std::sqrt(std::max(still.variance, kRoundingVariance));
    channel.points.push_back({{still.code, sd, still.count}, uncertainty});
  };
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double span = place(pixels[i]) - place(pixels[begin]);
    const std::size_t count = i - begin;
    if (span > kSparseWidth && count < kGroupPixels) {
      if (count >= kMinGroupPixels) {
        close(i);
      } else {
        begin = i;  // too few to say anything
      }
    } else if (span > 1 && count >= kGroupPixels) {
      close(i);
    }
  }
  if (pixels.size() - begin >= kMinGroupPixels || channel.points.empty()) close(pixels.size());
}

NoiseEstimate NoiseEstimator::estimate() const {
  NoiseEstimate estimate;
  estimate.sample_count = sample_count_;
  estimate.noise.white_code = capture_.white_code;
  estimate.noise.transfer = capture_.transfer;
  for (const ChannelPoints& channel : channels_) {
    if (channel.points.empty()) throw UnknownNoise("no pixel is still: noise is measured on a scene that is");
    // Where codes are cut off at black or white, they stray less than the light does.
    std::vector<MeasuredPoint> points;
    std::ranges::copy_if(channel.points, std::back_inserter(points), [&](const MeasuredPoint& each) {
      const double reach = kClipping * each.point.sd;
      return each.point.code >= reach && each.point.code + reach <= capture_.white_code;
    });
    if (points.empty()) {
      throw UnknownNoise("all pixels are black or white, where noise is cut off: film a scene with greys");
    }
    points = joined(std::move(points), capture_.white_code);
    const SensorFit fit = fit_sensor(points, capture_.white_code, capture_.transfer);
    ChannelNoise noise;
    const bool fits = fit.misfit <= kLargestMisfit && fit.worst <= kWorstMisfit;
    noise.curve = fits ? NoiseCurve::sensor : NoiseCurve::points;
    noise.read = six_digits(fit.read);
    noise.shot = six_digits(fit.shot);
    for (const auto& [point, uncertainty] : points) {
      noise.points.push_back({six_digits(point.code), six_digits(point.sd), point.pixels});
    }
    estimate.noise.channels.push_back(std::move(noise));
    estimate.channels.push_back(
        {fit.misfit, static_cast<double>(channel.still_pixels) / static_cast<double>(channel.pixels),
         std::max(channel.beside, channel.below) / channel.variance,
         static_cast<double>(channel.uneven) /
             static_cast<double>(std::max<std::uint64_t>(channel.told, 1))});
  }
  return estimate;
}

}  // namespace nutik
