#include "support/noisy_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace nutik::test {

double Normal::next() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2 * std::log(1 - random_.real(0, 1)));
  const double angle = 2 * std::numbers::pi * random_.real(0, 1);
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

std::uint32_t NoisyCamera::code_of(double light) const {
  const double fraction = light <= 0 ? 0 : std::min(format.transfer.fraction_of(light), 1.0);
  return static_cast<std::uint32_t>(std::lround(fraction * format.white_code));
}

NoisyCamera::Moments NoisyCamera::moments(double light) const {
  const double sd = std::sqrt(read * read + shot * light);
  const std::vector<double> thresholds = format.transfer.code_thresholds(format.white_code);
  const auto below = [&](double threshold) {
    return std::erfc((light - threshold) / sd / std::numbers::sqrt2) / 2;
  };
  double mean = 0, squares = 0, before = 0;  // everything below the first threshold is code 0
  for (std::uint32_t code = 0; code <= format.white_code; ++code) {
    const double until = code == format.white_code ? 1.0 : below(thresholds[code + 1]);
    const double share = until - before;
    mean += share * code;
    squares += share * code * code;
    before = until;
  }
  return {mean, std::sqrt(std::max(squares - mean * mean, 0.0))};
}

NoisyCamera camera_of(Shape shape, std::uint32_t white, Transfer transfer, double read, double shot) {
  NoisyCamera camera{.format = {}, .read = read, .shot = shot};
  camera.format.shape = shape;
  camera.format.code_bytes = white > 255 ? 2 : 1;
  camera.format.white_code = white;
  camera.format.transfer = transfer;
  return camera;
}

double waves(double x, double y, double k, int count, double shortest) {
  double sum = 0;
  for (int j = 0; j < count; ++j) {
    const double length = shortest + 4 * j, angle = 0.9 * j;
    const double along = (x * std::cos(angle) + y * std::sin(angle)) / length;
    sum += std::sin(2 * std::numbers::pi * along + 1.7 * j + (0.7 + 0.3 * j) * k);
  }
  return sum;
}

NoiseEstimator::ReadSample reader_of(const Rasters& rasters) {
  return [&rasters, next = std::size_t{0}](std::span<std::byte> raster) mutable {
    if (next == rasters.size()) return false;
    std::ranges::copy(rasters[next++], raster.begin());
    return true;
  };
}

Rasters film(const NoisyCamera& camera, std::uint64_t sample_count, std::uint64_t seed, const Light& light) {
  Normal normal(seed);
  Rasters rasters;
  for (std::uint64_t k = 0; k < sample_count; ++k) {
    std::vector<std::byte> raster(camera.format.sample_bytes());
    for (std::uint64_t value = 0; value < camera.format.shape.value_count(); ++value) {
      const double expected = light(value, k);
      const double sd = std::sqrt(camera.read * camera.read + camera.shot * expected);
      set_code(camera.format, raster, value, camera.code_of(expected + sd * normal.next()));
    }
    rasters.push_back(std::move(raster));
  }
  return rasters;
}

Light still_wedge(const NoisyCamera& camera, double darkest, double brightest) {
  const Shape shape = camera.format.shape;
  const Transfer transfer = camera.format.transfer;
  const double low = transfer.fraction_of(darkest), high = transfer.fraction_of(brightest);
  return [=](std::uint64_t value, std::uint64_t) {
    const std::uint64_t x = value / shape.channels % shape.width, channel = value % shape.channels;
    const double share = static_cast<double>(x) / std::max<double>(shape.width - 1, 1);
    const double place = channel == 1 ? 1 - share : share;  // green runs the other way
    return transfer.light_of(low + (high - low) * place);
  };
}

void interpolate_mosaic(Rasters& rasters, const Shape& shape) {
  for (auto& raster : rasters) {
    auto* codes = reinterpret_cast<std::uint16_t*>(raster.data());
    const std::vector<std::uint16_t> mosaic(codes, codes + shape.pixel_count());
    for (std::uint32_t y = 1; y + 1 < shape.height; ++y) {
      for (std::uint32_t x = 1; x + 1 < shape.width; ++x) {
        if ((x + y) % 2 == 0) continue;  // measured
        const std::size_t i = std::size_t{y} * shape.width + x;
        codes[i] = static_cast<std::uint16_t>(
            (mosaic[i - 1] + mosaic[i + 1] + mosaic[i - shape.width] + mosaic[i + shape.width] + 2) / 4);
      }
    }
  }
}

}  // namespace nutik::test
