// Footage of a synthetic scene, by a camera whose noise is known: what noise models are tested on.
#pragma once

#include <cstdint>
#include <functional>

#include "capture/picture.hpp"
#include "noise/noise_estimator.hpp"
#include "support/random_case.hpp"

namespace nutik::test {

// Normally distributed numbers with a fixed meaning per seed (Box and Muller).
class Normal {
 public:
  explicit Normal(std::uint64_t seed) : random_(seed) {}
  double next();

 private:
  Random random_;
  double spare_ = 0;
  bool has_spare_ = false;
};

struct NoisyCamera {
  CaptureFormat format;
  double read = 0.004;   // standard deviation in light where there is none
  double shot = 0.0004;  // variance in light for each unit of light

  // The code that light, noise included, is recorded as.
  [[nodiscard]] std::uint32_t code_of(double light) const;

  // What codes are expected to be, and their standard deviation, where the light is `light`: from the
  // probability of each code, without any of the model's formulas.
  struct Moments {
    double mean = 0;
    double sd = 0;
  };
  [[nodiscard]] Moments moments(double light) const;
};

[[nodiscard]] NoisyCamera camera_of(Shape shape, std::uint32_t white, Transfer transfer, double read = 0.004,
                                    double shot = 0.0004);

// Light of a value (pixel and channel, as in a raster) at a sample, without noise.
using Light = std::function<double(std::uint64_t value, std::uint64_t sample)>;

[[nodiscard]] Rasters film(const NoisyCamera& camera, std::uint64_t sample_count, std::uint64_t seed,
                           const Light& light);

// A still scene of all light from `darkest` to `brightest`, evenly in code, over the picture's width; channels
// differ.
[[nodiscard]] Light still_wedge(const NoisyCamera& camera, double darkest, double brightest);

// The sum of `count` waves in several directions that pass through the picture: one of `shortest` pixels, and each four
// longer than the one before.
[[nodiscard]] double waves(double x, double y, double k, int count, double shortest);

// One sample after the other; they must live as long.
[[nodiscard]] NoiseEstimator::ReadSample reader_of(const Rasters& rasters);

// Every other pixel of grey samples of 16 bits becomes the mean of the four beside it, as a camera makes of a mosaic.
void interpolate_mosaic(Rasters& rasters, const Shape& shape);

}  // namespace nutik::test
