// Measures a camera's noise on footage of a still scene.
//
//   in:      one clip or several, of one format: several exposures of one scene cover more codes
//   out:     points and fit for every channel (capture/noise_model.hpp)
//   always:  what moves, flickers or is stuck is left out: the pixels of a code vary alike, and those that
//            vary far more than most are none of them. Memory does not depend on the clips' length
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "capture/error.hpp"
#include "capture/memory_needs.hpp"
#include "capture/noise_model.hpp"
#include "capture/picture.hpp"
#include "noise/still_window.hpp"

namespace nutik {

// A point, and how sure it is: the share of its standard deviation that it may be off by.
struct MeasuredPoint {
  NoisePoint point;
  double uncertainty = 0;
};

struct SensorFit {
  double read = 0;  // as in ChannelNoise
  double shot = 0;
  // By which share sd differs between the points and the fit: root of the mean square, and the largest, of the
  // three quarters of the points that lie closest. Others may be of something else than noise.
  double misfit = 0;
  double worst = 0;
};

// The read and shot noise that measured points come from: weighted least squares of variance in light over light,
// neither noise below 0, with little say for points far off the line. At least one point.
[[nodiscard]] SensorFit fit_sensor(std::span<const MeasuredPoint> points, std::uint32_t white_code,
                                   const Transfer& transfer);

struct NoiseEstimate {
  struct Channel {
    double misfit = 0;       // of the sensor's curve: SensorFit::misfit
    double still_share = 0;  // of the pixels, over all windows: those that points were measured on
    // The share of their straying that a pixel kNeighbourPixels beside or below has, too: nearly none for light on a
    // sensor, much for what moves or what a codec left.
    double shared = 0;
    // Among the codes at which pixels stray by a code or more, the share at which some pixels stray a quarter more than
    // others: a sensor's noise depends on the code, motion on edges.
    double uneven = 0;
  };

  CameraNoise noise;
  std::vector<Channel> channels;
  std::uint64_t sample_count = 0;  // that were looked at
};

// The footage does not tell how noisy its camera is.
struct UnknownNoise : InputError {
  using InputError::InputError;
};

class NoiseEstimator {
 public:
  // Writes the next sample as an interleaved raster and returns true, or returns false at the end.
  using ReadSample = std::function<bool(std::span<std::byte> raster)>;

  // Enough for any clip: its first minute or so.
  static constexpr std::uint64_t kMaxSamples = 1024;
  static constexpr std::uint32_t kAnyThreads = ~std::uint32_t{0};

  // Channels are measured side by side, at most so many at a time.
  explicit NoiseEstimator(const CaptureFormat& capture, std::uint32_t threads = kAnyThreads);

  // What a clip of at most so many samples takes while it is measured on, one channel at a time.
  [[nodiscard]] static MemoryNeeds needs(const CaptureFormat& capture, std::uint64_t max_samples);
  // On how many threads it may be measured in so much memory, which is what it needs at least.
  [[nodiscard]] static std::uint32_t threads_in(std::uint64_t bytes, const CaptureFormat& capture,
                                                std::uint64_t max_samples);

  // Reads up to `max_samples` of the clip `name`. Throws UnknownNoise where there are fewer than
  // kMinWindowSamples.
  void add_clip(const std::string& name, const ReadSample& read_sample,
                std::uint64_t max_samples = kMaxSamples);

  // Throws UnknownNoise where no pixel is still or all are black or white. Numbers have six digits.
  [[nodiscard]] NoiseEstimate estimate() const;

 private:
  // The pixels of a channel over all windows of a clip; every `stride`-th is kept.
  struct Pixels {
    std::vector<PixelNoise> kept;
    std::uint64_t stride = 1;
    std::uint64_t seen = 0;

    void add(std::span<const PixelNoise> pixels);
  };

  struct ChannelPoints {
    std::vector<MeasuredPoint> points;
    std::uint64_t still_pixels = 0;
    std::uint64_t pixels = 0;
    double variance = 0, beside = 0, below = 0;  // sums over still pixels
    std::uint64_t told = 0, uneven = 0;          // groups of which it is known whether pixels stray unevenly
  };

  void add_points(ChannelPoints& channel, std::vector<PixelNoise> pixels, double degrees) const;

  CaptureFormat capture_;
  std::uint32_t threads_;
  std::vector<ChannelPoints> channels_;
  std::uint64_t sample_count_ = 0;
};

}  // namespace nutik
