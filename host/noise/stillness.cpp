#include "noise/stillness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "noise/still_window.hpp"

namespace nutik {
namespace {

constexpr std::uint64_t kMaxComparedPixels = 16 * 1024;
constexpr std::uint64_t kRegionPixels = 64;  // looked at, or more
constexpr std::uint32_t kMaxRegions = 8;    // in a row, and in a column
constexpr double kMinTold = 16;  // pixels of a region, over all stretches: fewer tell nothing of it
// Standard deviations of a difference of means from which on a capture sees a change in it: 1.5 times the three that
// its band has where nothing else is said.
constexpr float kChange = 4.5F;
constexpr double kSure = 5;      // standard deviations of a mean: one in 3.5 million is further off
constexpr double kCutOff = 3;  // standard deviations from black and white within which codes are cut off

// Two halves of some samples, [begin, middle) and [middle, end).
struct Halves {
  std::uint32_t begin, middle, end;
  std::size_t within;  // the halves of which these are one, as an index; the first are their own

  [[nodiscard]] bool are_single() const { return end - begin == 2; }
  // The variance of the difference of their means, where each sample's is 1.
  [[nodiscard]] double variance() const { return 1.0 / (middle - begin) + 1.0 / (end - middle); }
};

// All halves, and halves of these, of so many samples: one less than they are. The differences of their means, each as
// a share of its own standard deviation, are independent, and their squares sum up to those of the samples from
// their mean.
void add_halves(std::uint32_t begin, std::uint32_t end, std::size_t within, std::vector<Halves>& all) {
  if (end - begin < 2) return;
  const std::uint32_t middle = begin + (end - begin) / 2;
  const std::size_t index = all.size();
  all.push_back({begin, middle, end, within});
  add_halves(begin, middle, index, all);
  add_halves(middle, end, index, all);
}

// Every column, or row, or two of each `pitch` that lie kNeighbourPixels apart.
std::vector<std::uint32_t> places(std::uint32_t size, std::uint32_t pitch) {
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t i = 0; i < size; ++i) {
    if (pitch == 1 || i % pitch == 0 || i % pitch == kNeighbourPixels) chosen.push_back(i);
  }
  return chosen;
}

std::uint32_t pitch_of(const Shape& shape) {
  std::uint32_t pitch = 1;
  const auto count = [&] {
    return std::uint64_t{places(shape.width, pitch).size()} * places(shape.height, pitch).size();
  };
  while (count() > kMaxComparedPixels) pitch = std::max(pitch + 1, kNeighbourPixels + 1);
  return pitch;
}

// For each chosen place, which of them is kNeighbourPixels behind it; itself where none is.
std::vector<std::uint32_t> neighbours(std::span<const std::uint32_t> chosen) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < chosen.size(); ++i) {
    const auto at = std::ranges::lower_bound(chosen, chosen[i] + kNeighbourPixels);
    const bool is_there = at != chosen.end() && *at == chosen[i] + kNeighbourPixels;
    found.push_back(is_there ? static_cast<std::uint32_t>(at - chosen.begin()) : i);
  }
  return found;
}

// A mean, and its standard deviation as the values themselves tell it.
struct Mean {
  double count = 0, sum = 0, squares = 0;

  void add(double value) {
    count += 1;
    sum += value;
    squares += value * value;
  }
  void add(const Mean& other) {
    count += other.count;
    sum += other.sum;
    squares += other.squares;
  }
  [[nodiscard]] double value() const { return count > 0 ? sum / count : 0; }
  [[nodiscard]] double uncertainty() const {
    return count > 1 ? std::sqrt(std::max(squares / count - value() * value(), 0.0) / (count - 1)) : 0;
  }
};

// A variance beyond noise's as it was found, and the largest that may be.
struct Excess {
  double variance = 0, limit = 1;

  [[nodiscard]] bool is_above() const { return variance > limit; }
  [[nodiscard]] double share() const { return variance / limit; }
  [[nodiscard]] double stray() const { return std::sqrt(std::max(variance, 0.0)); }
};

// A capture's mean of so many samples is as unsure: where that is more, movement may add as much as noise leaves.
double max_excess(std::uint64_t samples) {
  return std::max(StillnessWatch::kMaxStray * StillnessWatch::kMaxStray, 1 / static_cast<double>(samples));
}

}  // namespace

// Three ways to find the same variance, each as a share of the noise's. What goes on for several samples is in the
// differences of long halves and not in those of single samples; what is common to neighbours is in their products.
struct StillnessWatch::Sums {
  std::array<Mean, 3> ways;

  void add(const Sums& other) {
    for (std::size_t i = 0; i < ways.size(); ++i) ways[i].add(other.ways[i]);
  }
  [[nodiscard]] Excess worst(double may_be) const { return mean_of({this, 1}, may_be); }

  // Over regions of which enough is known; each counts alike, however many of its pixels do not change.
  [[nodiscard]] static Excess mean_of(std::span<const Sums> regions, double may_be) {
    Excess most;
    bool is_first = true;
    for (std::size_t way = 0; way < regions.front().ways.size(); ++way) {
      double count = 0, variance = 0, squares = 0;
      for (const Sums& region : regions) {
        const Mean& mean = region.ways[way];
        if (mean.count < kMinTold && regions.size() > 1) continue;
        count += 1;
        variance += mean.value();
        squares += mean.uncertainty() * mean.uncertainty();
      }
      if (count == 0) continue;
      const Excess found{variance / count, may_be + kSure * std::sqrt(squares) / count};
      if (is_first || found.share() > most.share()) most = found;
      is_first = false;
    }
    return most;
  }
};

// One channel of some samples: of each pixel the differences between halves, as shares of their standard deviations.
class StillnessWatch::Stretch {
 public:
  Stretch(const StillnessWatch& watch, const CameraNoise& noise, std::uint32_t channel, std::uint64_t begin,
          std::uint64_t end)
      : watch_(watch), samples_(static_cast<std::uint32_t>(end - begin)), pixels_(watch.pixels_.size()) {
    add_halves(0, samples_, 0, halves_);
    sums_.resize(pixels_ * (samples_ + std::size_t{1}));
    for (std::uint32_t k = 0; k < samples_; ++k) {
      const std::uint16_t* codes = watch.plane(begin + k, channel);
      const std::uint32_t* before = sums(k);
      std::uint32_t* after = sums_.data() + (k + std::size_t{1}) * pixels_;
      for (std::size_t i = 0; i < pixels_; ++i) after[i] = before[i] + codes[i];
    }
    const double white = noise.white_code;
    std::vector<float> precision(pixels_);
    is_told_.resize(pixels_);
    for (std::size_t i = 0; i < pixels_; ++i) {
      const double mean = static_cast<double>(sums(samples_)[i]) / samples_;
      const double sd = noise.sd(channel, mean);
      precision[i] = static_cast<float>(1 / sd);
      is_told_[i] = mean >= kCutOff * sd && mean + kCutOff * sd <= white;
    }
    changes_.resize(halves_.size() * pixels_);
    differences_.resize(halves_.size() * pixels_);
    for (std::size_t h = halves_.size(); h-- > 0;) {
      const Halves& halves = halves_[h];
      const std::uint32_t *a = sums(halves.begin), *b = sums(halves.middle), *c = sums(halves.end);
      const auto of_early = 1.0F / static_cast<float>(halves.middle - halves.begin);
      const auto of_late = 1.0F / static_cast<float>(halves.end - halves.middle);
      const auto scale = static_cast<float>(1 / std::sqrt(halves.variance()));
      float* found = differences_.data() + h * pixels_;
      std::uint8_t *changes = changes_.data() + h * pixels_,
                   *around = changes_.data() + halves.within * pixels_;
      for (std::size_t i = 0; i < pixels_; ++i) {
        const float early = static_cast<float>(b[i] - a[i]) * of_early;
        const float late = static_cast<float>(c[i] - b[i]) * of_late;
        found[i] = (late - early) * scale * precision[i];
        changes[i] |= std::fabs(found[i]) > kChange;
        around[i] |= changes[i];
      }
    }
  }

  // Adds up, region by region, what pixels stray by while they do not visibly change: over samples in no halves of
  // which a change is seen.
  void add_strays(std::span<Sums> regions) const {
    std::vector<float> longer(pixels_), single(pixels_), longer_count(pixels_), single_count(pixels_);
    std::vector<float> beside(pixels_), below(pixels_);
    for (std::size_t h = 0; h < halves_.size(); ++h) {
      const float* z = differences_.data() + h * pixels_;
      const std::uint8_t* changes = changes_.data() + h * pixels_;
      float* squares = halves_[h].are_single() ? single.data() : longer.data();
      float* counts = halves_[h].are_single() ? single_count.data() : longer_count.data();
      for (std::size_t i = 0; i < pixels_; ++i) {
        if (changes[i] != 0) continue;
        const std::uint32_t right = watch_.beside_[i], down = watch_.below_[i];
        squares[i] += z[i] * z[i];
        counts[i] += 1;
        if (changes[right] == 0) beside[i] += z[i] * z[right];
        if (changes[down] == 0) below[i] += z[i] * z[down];
      }
    }
    const double of_all = 1.0 / samples_;
    for (std::size_t i = 0; i < pixels_; ++i) {
      if (!is_told_[i]) continue;
      auto& ways = regions[watch_.region_[i]].ways;
      // With noise alone the squares of all differences are the same on average; the excess of the long ones is not
      // noise. So single samples are the measure, whatever the model says.
      const float of_noise = single_count[i] > 0 ? longer_count[i] * single[i] / single_count[i] : 0;
      ways[0].add((longer[i] - of_noise) * of_all);
      const auto add_neighbour = [&](Mean& to, std::uint32_t neighbour, float product) {
        if (neighbour != i && is_told_[neighbour]) to.add(product * of_all);
      };
      add_neighbour(ways[1], watch_.beside_[i], beside[i]);
      add_neighbour(ways[2], watch_.below_[i], below[i]);
    }
  }

  // What pixels stray by beyond noise, and how much of it they do all together. A change counts as the least of one.
  void add_brightness(Mean& of_pixels, Mean& of_all) const {
    double pixels = 0, together = 0;
    for (std::size_t h = 0; h < halves_.size(); ++h) {
      const float* z = differences_.data() + h * pixels_;
      Mean mean;
      for (std::size_t i = 0; i < pixels_; ++i) {
        if (is_told_[i]) mean.add(std::clamp(z[i], -kChange, kChange));
      }
      if (mean.count == 0) return;
      pixels += mean.squares / mean.count - 1;
      together += mean.value() * mean.value();
    }
    of_pixels.add(pixels / samples_);
    of_all.add(together / samples_);
  }

 private:
  [[nodiscard]] const std::uint32_t* sums(std::uint32_t samples) const {
    return sums_.data() + samples * pixels_;
  }

  const StillnessWatch& watch_;
  std::uint32_t samples_;
  std::size_t pixels_;
  std::vector<Halves> halves_;
  std::vector<std::uint32_t> sums_;    // [samples before][pixel]
  std::vector<float> differences_;     // [halves][pixel]
  std::vector<std::uint8_t> changes_;  // [halves][pixel]: whether one is seen in these, or in halves of them
  std::vector<std::uint8_t> is_told_;  // [pixel]: its codes are not cut off
};

StillnessWatch::StillnessWatch(const CaptureFormat& capture, std::uint64_t max_samples)
    : format_(capture), max_samples_(max_samples) {
  const Shape& shape = capture.shape;
  const std::uint32_t pitch = pitch_of(shape);
  const std::vector<std::uint32_t> columns = places(shape.width, pitch), rows = places(shape.height, pitch);
  const std::vector<std::uint32_t> right = neighbours(columns), down = neighbours(rows);
  const auto wide = static_cast<std::uint32_t>(columns.size());
  const double side = std::sqrt(static_cast<double>(columns.size() * rows.size()) / kRegionPixels);
  regions_ = std::clamp(static_cast<std::uint32_t>(side), 1U, kMaxRegions);
  for (std::uint32_t j = 0; j < rows.size(); ++j) {
    for (std::uint32_t i = 0; i < wide; ++i) {
      pixels_.push_back(std::uint64_t{rows[j]} * shape.width + columns[i]);
      beside_.push_back(j * wide + right[i]);
      below_.push_back(down[j] * wide + i);
      const std::uint64_t across = std::uint64_t{columns[i]} * regions_ / shape.width;
      const std::uint64_t along = std::uint64_t{rows[j]} * regions_ / shape.height;
      region_.push_back(static_cast<std::uint32_t>(along * regions_ + across));
    }
  }
}

std::uint64_t StillnessWatch::bytes(const Shape& shape, std::uint64_t max_samples) {
  const std::uint32_t pitch = pitch_of(shape);
  const std::uint64_t pixels =
      std::uint64_t{places(shape.width, pitch).size()} * places(shape.height, pitch).size();
  const std::uint64_t kept = max_samples * shape.channels * sizeof(std::uint16_t);
  const std::uint64_t places_of_it = sizeof(std::uint64_t) + 3 * sizeof(std::uint32_t);
  const std::uint64_t judged = (kStretchSamples + 1) * sizeof(std::uint32_t) +
                               (kStretchSamples + 7) * sizeof(float) +
                               (kStretchSamples + 1) * sizeof(std::uint8_t);
  return pixels * (kept + places_of_it + judged);
}

void StillnessWatch::add(std::span<const std::byte> raster) {
  if (samples_ == max_samples_) return;
  if (samples_ == 0) codes_.reserve(max_samples_ * format_.shape.channels * pixels_.size());
  const std::uint32_t channels = format_.shape.channels;
  for (std::uint32_t channel = 0; channel < channels; ++channel) {
    for (const std::uint64_t pixel : pixels_) {
      std::uint16_t code = 0;
      std::memcpy(&code, raster.data() + (pixel * channels + channel) * format_.code_bytes,
                  format_.code_bytes);
      codes_.push_back(code);
    }
  }
  ++samples_;
}

Stillness StillnessWatch::judge(const CameraNoise& noise) const {
  Stillness worst;
  for (std::uint32_t channel = 0; channel < format_.shape.channels; ++channel) {
    const Stillness found = judge(noise, channel);
    if (channel == 0 || found.stray * worst.limit > worst.stray * found.limit) worst = found;
  }
  return worst;
}

Stillness StillnessWatch::judge(const CameraNoise& noise, std::uint32_t channel) const {
  Stillness found;
  std::vector<Sums> regions(std::size_t{regions_} * regions_);
  Mean of_pixels, of_all;
  double max_in_time = -1;
  const std::uint64_t stretches = (samples_ + kStretchSamples - 1) / kStretchSamples;
  const double may_be = max_excess(samples_ / stretches);
  for (std::uint64_t s = 0; s < stretches; ++s) {
    const std::uint64_t begin = samples_ * s / stretches, end = samples_ * (s + 1) / stretches;
    const Stretch stretch(*this, noise, channel, begin, end);
    std::vector<Sums> of_stretch(regions.size());
    stretch.add_strays(of_stretch);
    stretch.add_brightness(of_pixels, of_all);
    for (std::size_t r = 0; r < regions.size(); ++r) regions[r].add(of_stretch[r]);
    const double strays = Sums::mean_of(of_stretch, may_be).stray();
    if (strays <= max_in_time) continue;
    max_in_time = strays;
    found.first_sample = begin;
    found.last_sample = end - 1;
  }
  const Excess excess = Sums::mean_of(regions, may_be);
  found.stray = excess.stray();
  found.limit = std::sqrt(excess.limit);
  found.is_brightness = of_all.value() > 0.5 * of_pixels.value();

  Excess most;
  most.variance = -1;
  std::uint64_t straying = 0;
  const auto edge = [this](std::uint32_t i, std::uint32_t size) {
    return static_cast<std::uint32_t>((std::uint64_t{i} * size + regions_ - 1) / regions_);
  };
  for (std::uint32_t r = 0; r < regions.size(); ++r) {
    const Excess here = regions[r].worst(may_be);
    straying += here.is_above();
    if (regions[r].ways[0].count < kMinTold || here.share() <= most.share()) continue;
    most = here;
    const std::uint32_t x = edge(r % regions_, format_.shape.width);
    const std::uint32_t y = edge(r / regions_, format_.shape.height);
    found.region = {x, y, edge(r % regions_ + 1, format_.shape.width) - x,
                    edge(r / regions_ + 1, format_.shape.height) - y};
  }
  found.max_stray = most.stray();
  found.max_limit = std::sqrt(most.limit);
  found.stray_share = static_cast<double>(straying) / static_cast<double>(regions.size());
  return found;
}

}  // namespace nutik
