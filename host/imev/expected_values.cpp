#include "imev/expected_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "imev/tile.hpp"

namespace nutik {
namespace {

constexpr std::uint32_t kLargestCode = 65'535;
constexpr std::uint32_t kLongestExcursion = 2;  // samples between two stretches of one level

// Samples [begin, end) of a pixel.
struct Stretch {
  std::uint32_t begin;
  std::uint32_t end;

  [[nodiscard]] std::uint32_t size() const { return end - begin; }
};

// 1/k + 1/(n - k): what the variance of one sample comes to in the difference between the mean of the first k
// of n samples and the mean of the others.
double difference_variance(std::uint32_t k, std::uint32_t n) { return 1.0 / k + 1.0 / (n - k); }

// The lanes, as bits, of a tile's plane [sample][stride] that may have to be cut: a look at 64 pixels
// at once that spares most of them the look at one. Sums are of differences from the first sample, so that
// single precision is enough where it matters: in pixels that hardly change.
template <typename Code>
std::uint64_t lanes_to_cut(const Code* plane, std::size_t stride, std::uint32_t samples,
                           const std::vector<float>& sd, float sigmas) {
  using Lanes = std::array<float, kTilePixels>;
  Lanes first, mean{}, limit, part{}, worst{};
  for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) first[lane] = plane[lane];
  for (std::uint32_t k = 1; k < samples; ++k) {
    const Code* row = plane + k * stride;
    for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
      mean[lane] += static_cast<float>(row[lane]) - first[lane];
    }
  }
  for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
    mean[lane] /= static_cast<float>(samples);
    limit[lane] = sigmas * sd[static_cast<std::size_t>(std::lround(first[lane] + mean[lane]))];
  }
  for (std::uint32_t k = 1; k < samples; ++k) {
    const Code* row = plane + (k - 1) * stride;
    const auto count = static_cast<float>(k);
    const auto weight = static_cast<float>(difference_variance(k, samples));
    for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
      part[lane] += static_cast<float>(row[lane]) - first[lane];
      const float surplus = part[lane] - count * mean[lane];
      worst[lane] = std::max(worst[lane], surplus * surplus * weight);
    }
  }
  std::uint64_t bits = 0;
  for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
    bits |= std::uint64_t{worst[lane] > limit[lane] * limit[lane]} << lane;
  }
  return bits;
}

}  // namespace

std::uint32_t held_scale(const CaptureFormat& source) {
  return source.noise.camera ? kLargestCode / source.noise.camera->white_code : 1;
}

CaptureFormat held_format(const CaptureFormat& source) {
  CaptureFormat held = source;
  if (source.noise.camera) {
    held.code_bytes = 2;
    held.white_code = source.noise.camera->white_code * held_scale(source);
  }
  return held;
}

std::vector<std::byte> to_held_codes(const CaptureFormat& source, std::span<const std::byte> raster) {
  if (!source.noise.camera) return {raster.begin(), raster.end()};
  const std::uint32_t scale = held_scale(source);
  std::vector<std::byte> held(held_format(source).sample_bytes());
  for (std::uint64_t value = 0; value < source.shape.value_count(); ++value) {
    std::uint16_t code = 0;
    std::memcpy(&code, raster.data() + value * source.code_bytes, source.code_bytes);
    code = static_cast<std::uint16_t>(code * scale);
    std::memcpy(held.data() + value * sizeof code, &code, sizeof code);
  }
  return held;
}

ExpectedValues::ExpectedValues(const CaptureFormat& source)
    : channels_(source.shape.channels),
      code_bytes_(source.code_bytes),
      white_code_(source.white_code),
      scale_(held_scale(source)),
      sigmas_(source.noise.sigmas),
      transfer_(source.transfer),
      light_(source.transfer.light_of_codes(source.white_code)) {
  const CameraNoise& camera = source.noise.camera.value();
  if (camera.channels.size() != channels_) {
    throw UsageError(format("the noise was measured on {} channel{} and the clip has {}; measure it on a "
                            "clip of the same kind, or on the clip itself",
                            camera.channels.size(), camera.channels.size() == 1 ? "" : "s", channels_),
                     {Setting::automatic_noise});
  }
  if (camera.white_code != white_code_) {
    throw UsageError(format("the noise was measured with white code {} and the clip's is {}; measure it on a "
                            "clip of the same kind, or on the clip itself",
                            camera.white_code, white_code_),
                     {Setting::automatic_noise});
  }
  for (std::uint32_t channel = 0; channel < channels_; ++channel) {
    sd_.push_back(camera.sd_of_codes(channel));
    // Near black the noise changes much from one code to the next: the band is that of what is held, whose codes are
    // finer.
    std::vector<float>& held_sd = held_sd_.emplace_back(std::size_t{white_code_} * scale_ + 1);
    for (std::size_t code = 0; code < held_sd.size(); ++code) {
      held_sd[code] = static_cast<float>(camera.sd(channel, static_cast<double>(code) / scale_));
    }
  }
}

// One pixel of a tile at a time: its samples, cut into levels.
template <typename Code>
class ExpectedValues::Pixel {
 public:
  Pixel(const ExpectedValues& model, const Code* codes, std::uint32_t samples)
      : model_(model),
        tile_codes_(codes),
        samples_(samples),
        codes_(std::size_t{model.channels_} * samples),
        sums_(std::size_t{model.channels_} * (samples + 1)),
        level_of_(samples) {}

  void hold(std::uint32_t lane, bool may_change, Held& held) {
    take(lane);
    levels_.clear();
    if (may_change) {
      cut();
      join();
    } else {
      add_level({0, samples_});
    }
    for (std::uint32_t level = 0; level < levels_.size(); ++level) settle(level);
    write(lane, held);
  }

 private:
  struct Level {
    Stretch span;  // all of the level lies within it
    std::uint32_t samples;
    std::array<std::uint16_t, 3> held;
  };
  static constexpr std::uint32_t kItself = ~std::uint32_t{0};  // the level of a sample that stands for itself

  [[nodiscard]] const Code* samples_of(std::uint32_t channel) const {
    return codes_.data() + std::size_t{channel} * samples_;
  }
  [[nodiscard]] double mean(std::uint32_t channel, Stretch stretch) const {
    const double* sums = sums_.data() + std::size_t{channel} * (samples_ + 1);
    return (sums[stretch.end] - sums[stretch.begin]) / stretch.size();
  }
  [[nodiscard]] double sd(std::uint32_t channel, double code) const {
    return model_.sd_[channel][static_cast<std::size_t>(std::lround(code))];
  }

  void take(std::uint32_t lane) {
    for (std::uint32_t channel = 0; channel < model_.channels_; ++channel) {
      Code* codes = codes_.data() + std::size_t{channel} * samples_;
      double* sums = sums_.data() + std::size_t{channel} * (samples_ + 1);
      for (std::uint32_t k = 0; k < samples_; ++k) {
        codes[k] = tile_codes_[(std::size_t{k} * model_.channels_ + channel) * kTilePixels + lane];
        sums[k + 1] = sums[k] + codes[k];
      }
    }
  }

  // Where a stretch falls into two levels; its begin where it is one.
  [[nodiscard]] std::uint32_t best_cut(Stretch stretch) const {
    std::uint32_t best = stretch.begin;
    double most = 1;
    for (std::uint32_t channel = 0; channel < model_.channels_; ++channel) {
      const double* sums = sums_.data() + std::size_t{channel} * (samples_ + 1);
      const double whole_mean = mean(channel, stretch);
      const double limit = kCutShare * model_.sigmas_ * sd(channel, whole_mean);
      const double scale = 1 / (limit * limit);
      for (std::uint32_t k = 1; k < stretch.size(); ++k) {
        const double surplus = sums[stretch.begin + k] - sums[stretch.begin] - k * whole_mean;
        const double excess = surplus * surplus * difference_variance(k, stretch.size()) * scale;
        if (excess > most) {
          most = excess;
          best = stretch.begin + k;
        }
      }
    }
    return best;
  }

  void cut() {
    stretches_.clear();
    uncut_.assign(1, {0, samples_});
    while (!uncut_.empty()) {
      const Stretch stretch = uncut_.back();
      uncut_.pop_back();
      const std::uint32_t at = best_cut(stretch);
      if (at == stretch.begin) {
        stretches_.push_back(stretch);
      } else {
        uncut_.push_back({at, stretch.end});
        uncut_.push_back({stretch.begin, at});
      }
    }
  }

  [[nodiscard]] bool are_one_level(Stretch a, Stretch b) const {
    for (std::uint32_t channel = 0; channel < model_.channels_; ++channel) {
      const double of_a = mean(channel, a), of_b = mean(channel, b);
      const double limit = model_.sigmas_ * sd(channel, of_a) * std::sqrt(1.0 / a.size() + 1.0 / b.size());
      if (!(std::abs(of_a - of_b) <= limit)) return false;
    }
    return true;
  }

  void add_level(Stretch stretch) {
    std::fill(level_of_.begin() + stretch.begin, level_of_.begin() + stretch.end,
              static_cast<std::uint32_t>(levels_.size()));
    levels_.push_back({stretch, stretch.size(), {}});
  }

  // Stretches become levels; those on either side of a short excursion may be one.
  void join() {
    for (std::size_t i = 0; i < stretches_.size(); ++i) {
      const bool follows_excursion = i >= 2 && stretches_[i - 1].size() <= kLongestExcursion;
      if (follows_excursion && are_one_level(stretches_[i - 2], stretches_[i])) {
        const std::uint32_t earlier = level_of_[stretches_[i - 2].begin];
        std::fill(level_of_.begin() + stretches_[i].begin, level_of_.begin() + stretches_[i].end, earlier);
        levels_[earlier].span.end = stretches_[i].end;
        levels_[earlier].samples += stretches_[i].size();
      } else {
        add_level(stretches_[i]);
      }
    }
  }

  // Lets samples outside the band stand for themselves, until all others are within that of their mean.
  void settle(std::uint32_t number) {
    Level& level = levels_[number];
    while (level.samples > 1) {
      level.held = expected_codes(number);
      if (!drop_outliers(number)) return;
    }
    if (level.samples == 1) {
      for (std::uint32_t k = level.span.begin; k < level.span.end; ++k) {
        if (level_of_[k] == number) level_of_[k] = kItself;
      }
    }
  }

  [[nodiscard]] std::array<std::uint16_t, 3> expected_codes(std::uint32_t number) const {
    const Level& level = levels_[number];
    std::array<std::uint16_t, 3> held{};
    for (std::uint32_t channel = 0; channel < model_.channels_; ++channel) {
      const Code* codes = samples_of(channel);
      double light = 0;
      Code low = std::numeric_limits<Code>::max(), high = 0;
      for (std::uint32_t k = level.span.begin; k < level.span.end; ++k) {
        if (level_of_[k] != number) continue;
        light += model_.light_[codes[k]];
        low = std::min(low, codes[k]);
        high = std::max(high, codes[k]);
      }
      const double code =
          low == high ? low : model_.transfer_.fraction_of(light / level.samples) * model_.white_code_;
      held[channel] = static_cast<std::uint16_t>(std::lround(code * model_.scale_));
    }
    return held;
  }

  bool drop_outliers(std::uint32_t number) {
    Level& level = levels_[number];
    std::array<double, 3> band{};
    for (std::uint32_t channel = 0; channel < model_.channels_; ++channel) {
      band[channel] = model_.sigmas_ * model_.held_sd_[channel][level.held[channel]] * model_.scale_;
    }
    bool dropped = false;
    for (std::uint32_t k = level.span.begin; k < level.span.end; ++k) {
      if (level_of_[k] != number) continue;
      bool is_outside = false;
      for (std::uint32_t channel = 0; channel < model_.channels_; ++channel) {
        const double code = static_cast<double>(samples_of(channel)[k]) * model_.scale_;
        is_outside |= std::abs(code - level.held[channel]) > band[channel];
      }
      if (!is_outside) continue;
      level_of_[k] = kItself;
      --level.samples;
      dropped = true;
    }
    return dropped;
  }

  void write(std::uint32_t lane, Held& held) const {
    std::array<std::uint16_t, 3> before{};
    for (std::uint32_t k = 0; k < samples_; ++k) {
      std::array<std::uint16_t, 3> now{};
      for (std::uint32_t channel = 0; channel < model_.channels_; ++channel) {
        now[channel] = level_of_[k] == kItself
                           ? static_cast<std::uint16_t>(samples_of(channel)[k] * model_.scale_)
                           : levels_[level_of_[k]].held[channel];
        held.codes[(std::size_t{k} * model_.channels_ + channel) * kTilePixels + lane] = now[channel];
      }
      if (k > 0 && now != before) held.changes[k] |= std::uint64_t{1} << lane;
      before = now;
    }
  }

  const ExpectedValues& model_;
  const Code* tile_codes_;  // [sample][C][64]
  std::uint32_t samples_;
  std::vector<Code> codes_;   // [channel][sample]
  std::vector<double> sums_;  // [channel][sample + 1] of all codes before
  std::vector<std::uint32_t> level_of_;
  std::vector<Level> levels_;
  std::vector<Stretch> stretches_, uncut_;
};

template <typename Code>
void ExpectedValues::find_in(const Code* codes, std::uint32_t samples, Held& held) const {
  std::uint64_t changing = 0;
  for (std::uint32_t channel = 0; channel < channels_; ++channel) {
    changing |= lanes_to_cut(codes + channel * kTilePixels, std::size_t{channels_} * kTilePixels, samples,
                             sd_[channel], static_cast<float>(kCutShare * sigmas_));
  }
  held.codes.resize(std::size_t{samples} * channels_ * kTilePixels);
  held.changes.assign(samples, 0);
  Pixel<Code> pixel(*this, codes, samples);
  for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
    pixel.hold(lane, (changing >> lane & 1) != 0, held);
  }
}

void ExpectedValues::find(const std::byte* codes, std::uint32_t samples, Held& held) const {
  with_codes(code_bytes_, codes, [&](const auto* of_tile) { find_in(of_tile, samples, held); });
}

}  // namespace nutik
