#include "media/deflicker.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "capture/format.hpp"
#include "capture/median.hpp"

namespace nutik {
namespace {

// Pixels; means of them have little noise. Smaller ones of pictures that would have too few to tell chance from.
std::uint32_t block_side(const Shape& shape) { return shape.pixel_count() < 4096 ? 2 : 4; }
constexpr std::uint32_t kMaxBlocksToASide = 48;  // spread over the picture
constexpr double kCode8 = 1.0 / 255;
// A correction that would be this much another is left as it is, so that still pixels keep their codes.
constexpr double kMinChange = 0.75 * kCode8;
// Pictures that are exposed alike, for one that seems not to be: of noise whose sign is chance, independent in tiles.
constexpr double kTrials = 10'000;
constexpr std::size_t kTileBlocks = 3;  // to a side: what moves differs in neighbouring blocks together
constexpr double kSteepest = 3;  // a camera neither swallows differences nor makes them larger than this
// Codes, for one that counts: of rarer ones neither the exposure can be told nor what a correction makes of them.
constexpr std::size_t kMaxSilent = 50;

// Tukey's: nothing from 4.685 standard deviations on, as usual.
double trust(double error, double deviation) {
  const double share = error / (4.685 * deviation);
  return std::abs(share) >= 1 ? 0.0 : (1 - share * share) * (1 - share * share);
}

// Black stays black and white stays white, however they are exposed; what noise adds to black is no light.
bool tells_exposure(double code, double wanted) {
  constexpr double kBlack = 2 * kCode8;
  return std::max(code, wanted) >= kBlack && std::min(code, wanted) <= 1 - kCode8;
}

// Means of blocks that are spread over a picture, as shares of white; channel by channel.
class Blocks {
 public:
  explicit Blocks(const CaptureFormat& format)
      : format_(format),
        side_(block_side(format.shape)),
        columns_(places(format.shape.width)),
        rows_(places(format.shape.height)) {}

  [[nodiscard]] std::vector<std::vector<double>> means(std::span<const std::byte> raster) const {
    return with_codes(format_.code_bytes, raster.data(), [&](const auto* codes) { return means(codes); });
  }

  // Noise that both pictures have alike gives each tile's difference either sign with the same chance: they might be
  // swapped. All tiles together are looked at, and those of each quarter of the codes, for both signs. None where too
  // few tell.
  [[nodiscard]] std::optional<bool> are_exposed_alike(std::span<const double> codes, std::span<const double> wanted,
                                       double trials) const {
    constexpr std::size_t kQuarters = 4;
    std::vector<double> sizes;
    for (std::size_t i = 0; i < codes.size(); ++i) {
      if (tells_exposure(codes[i], wanted[i])) sizes.push_back(std::abs(wanted[i] - codes[i]));
    }
    if (sizes.empty()) return true;
    const double deviation = std::max(1.4826 * median(sizes), kCode8);
    const std::size_t side = sizes.size() < 576 ? 1 : kTileBlocks, across = (columns_.size() - 1) / side + 1;
    std::array<std::vector<double>, 1 + kQuarters> tiles;
    tiles.fill(std::vector<double>(across * ((rows_.size() - 1) / side + 1)));
    std::vector<bool> tells(tiles.front().size());
    for (std::size_t i = 0; i < codes.size(); ++i) {
      if (!tells_exposure(codes[i], wanted[i])) continue;
      const double difference = wanted[i] - codes[i];
      const double quarter = std::min((codes[i] + wanted[i]) / 2 * kQuarters, kQuarters - 1.0);
      const std::size_t tile = i / columns_.size() / side * across + i % columns_.size() / side;
      tells[tile] = true;
      for (const std::size_t seen : {std::size_t{0}, 1 + static_cast<std::size_t>(quarter)})
        tiles[seen][tile] += trust(difference, deviation) * difference;
    }
    trials *= static_cast<double>(tiles.size());
    if (static_cast<double>(std::ranges::count(tells, true)) < 1 + std::log2(trials)) return std::nullopt;
    return std::ranges::all_of(tiles, [&](const std::vector<double>& differences) {
      return may_be_chance(differences, trials);
    });
  }

 private:
  [[nodiscard]] std::vector<std::uint32_t> places(std::uint32_t length) const {
    const std::uint32_t blocks = std::max(length / side_, 1u);
    const std::uint32_t count = std::min(blocks, kMaxBlocksToASide);
    std::vector<std::uint32_t> starts;
    for (std::uint64_t i = 0; i < count; ++i) {
      starts.push_back(static_cast<std::uint32_t>(i * blocks / count) * side_);
    }
    return starts;
  }

  template <typename Code>
  [[nodiscard]] std::vector<std::vector<double>> means(const Code* codes) const {
    const auto [width, height, channels] = format_.shape;
    std::vector<std::vector<double>> means(channels);
    for (const std::uint32_t top : rows_) {
      const std::uint32_t bottom = std::min(top + side_, height);
      for (const std::uint32_t left : columns_) {
        const std::uint32_t right = std::min(left + side_, width);
        std::array<std::uint64_t, 3> sums{};
        for (std::uint32_t y = top; y < bottom; ++y) {
          const Code* code = codes + (std::size_t{y} * width + left) * channels;
          for (std::uint32_t x = left; x < right; ++x) {
            for (std::uint32_t channel = 0; channel < channels; ++channel) sums[channel] += *code++;
          }
        }
        const double whole = static_cast<double>(format_.white_code) * (bottom - top) * (right - left);
        for (std::uint32_t channel = 0; channel < channels; ++channel) {
          means[channel].push_back(static_cast<double>(sums[channel]) / whole);
        }
      }
    }
    return means;
  }

  CaptureFormat format_;
  std::uint32_t side_;
  std::vector<std::uint32_t> columns_, rows_;
};

class DeflickeredClip final : public Clip {
 public:
  explicit DeflickeredClip(std::unique_ptr<Clip> clip)
      : clip_(std::move(clip)), info_(clip_->info()), blocks_(info_.format) {
    info_.roundings.add(0.5, kSteepest, "deflicker");
    info_.facts.push_back({std::string(kDeflickered), Origin::stated, Setting::deflicker});
    const CaptureFormat& format = info_.format;
    shifts_.resize(format.shape.channels);
    tables_.resize(format.shape.channels);
    for (auto& table : tables_) table.resize(std::size_t{1} << (8 * format.code_bytes));
    info_.decoder_bytes += tables_.size() * tables_.front().size() * sizeof tables_.front().front();
  }

  [[nodiscard]] const ClipInfo& info() const override { return info_; }

  bool read(std::span<std::byte> raster) override {
    if (!clip_->read(raster)) return false;
    std::vector<std::vector<double>> means = blocks_.means(raster);
    if (pictures_++ == 0) {
      first_ = told_ = std::move(means);
      return true;
    }
    if (follow(means)) {
      told_ = shifted(std::move(means));
    } else {
      ++untold_;
    }
    if (!is_shifted_) return true;
    ++corrected_;
    with_codes(info_.format.code_bytes, raster.data(), [&](auto* codes) {
      info_.format.shape.channels == 1 ? correct<1>(codes) : correct<3>(codes);
    });
    return true;
  }

  [[nodiscard]] std::optional<std::string> ended_early() const override { return clip_->ended_early(); }

  [[nodiscard]] std::vector<Note> remarks() const override {
    std::vector<Note> remarks = clip_->remarks();
    if (corrected_ > 0) {
      remarks.emplace_back(format("the exposure of {} of {} pictures was corrected, by up to {:.0f} of {} codes",
                                  corrected_.load(), pictures_.load(), max_ * info_.format.white_code,
                                  info_.format.white_code));
    }
    if (untold_ > 0) {
      remarks.emplace_back(
          format("{} of {} pictures follow no one curve from those before them, for they show too little of these or "
                 "are lit unequally, or need one steeper than {:.0f}: they were corrected as the one before each",
                 untold_.load(), pictures_.load(), kSteepest));
    }
    return remarks;
  }

 private:
  // By channel; none where one cannot be told.
  static std::vector<CodeShift> shifts_to(const std::vector<std::vector<double>>& reference,
                                          const std::vector<std::vector<double>>& means) {
    std::vector<CodeShift> shifts;
    for (std::size_t channel = 0; channel < means.size(); ++channel) {
      const auto shift = CodeShift::between(means[channel], reference[channel]);
      if (!shift) return {};
      shifts.push_back(*shift);
    }
    return shifts;
  }

  // False where it cannot be told.
  bool follow(const std::vector<std::vector<double>>& means) {
    // What comes into view hides what the first one shows, and not what the one before it did.
    std::vector<CodeShift> shifts = shifts_to(first_, means);
    if (shifts.empty()) shifts = shifts_to(told_, means);
    if (shifts.empty()) return false;
    double change = 0;
    for (std::size_t channel = 0; channel < means.size(); ++channel)
      change = std::max(change, shifts[channel].distance_to(shifts_[channel], means[channel]));
    const bool is_new = change >= kMinChange;
    if (!is_new && !is_shifted_) return true;
    const std::optional<bool> alike = is_alike(means);
    if (!alike) return !is_new;
    if (*alike) {
      shifts.assign(shifts.size(), {});
    } else if (!is_new || (is_shifted_ && is_alike(shifted(means)) == true)) {
      return true;
    }
    shifts_ = std::move(shifts);
    is_shifted_ = false;
    double most = 0;
    for (std::size_t channel = 0; channel < tables_.size(); ++channel) {
      most = std::max(most, shifts_[channel].distance_to({}, means[channel]));
      fill(tables_[channel], shifts_[channel]);
    }
    is_shifted_ = most >= kMinChange;
    if (most > max_) max_ = most;
    return true;
  }

  // None where it cannot be told.
  [[nodiscard]] std::optional<bool> is_alike(const std::vector<std::vector<double>>& means) const {
    std::optional<bool> alike = true;
    for (std::size_t channel = 0; channel < means.size(); ++channel) {
      const double trials = kTrials * static_cast<double>(means.size());
      const auto of_channel = blocks_.are_exposed_alike(means[channel], first_[channel], trials);
      if (of_channel == false) return false;
      if (!of_channel) alike.reset();
    }
    return alike;
  }

  // As they are corrected now.
  [[nodiscard]] std::vector<std::vector<double>> shifted(std::vector<std::vector<double>> means) const {
    for (std::size_t channel = 0; channel < means.size(); ++channel) {
      for (double& mean : means[channel]) mean += shifts_[channel].at(mean);
    }
    return means;
  }

  void fill(std::vector<std::uint16_t>& table, const CodeShift& shift) const {
    const double white = info_.format.white_code;
    std::uint16_t least = 0;
    for (std::size_t code = 0; code < table.size(); ++code) {
      const auto share = static_cast<double>(code) / white;
      const double shifted = std::round((share + shift.at(share)) * white);
      // What is above white stays there: it is refused later, with its place.
      least = std::max(least, code > info_.format.white_code
                                  ? static_cast<std::uint16_t>(code)
                                  : static_cast<std::uint16_t>(std::clamp(shifted, 0.0, white)));
      table[code] = least;
    }
  }

  template <std::size_t kChannels, typename Code>
  void correct(Code* codes) const {
    std::array<const std::uint16_t*, kChannels> tables;
    for (std::size_t channel = 0; channel < kChannels; ++channel) tables[channel] = tables_[channel].data();
    const Code* const end = codes + info_.format.shape.value_count();
    for (; codes != end; codes += kChannels) {
      for (std::size_t channel = 0; channel < kChannels; ++channel) {
        codes[channel] = static_cast<Code>(tables[channel][codes[channel]]);
      }
    }
  }

  std::unique_ptr<Clip> clip_;
  ClipInfo info_;
  Blocks blocks_;
  // Means of the first picture, and of the last that could be told, as it was corrected.
  std::vector<std::vector<double>> first_, told_;
  std::vector<CodeShift> shifts_;                   // by channel, as `tables_`
  std::vector<std::vector<std::uint16_t>> tables_;  // what each code becomes
  bool is_shifted_ = false;
  // Asked for while another thread reads.
  std::atomic<std::uint64_t> pictures_ = 0, corrected_ = 0, untold_ = 0;
  std::atomic<double> max_ = 0;
};

}  // namespace

// From one factor for all codes to shifts that differ more and more along them, each from what is left over by the one
// before: where codes are rare, what is known of others goes on.
std::optional<CodeShift> CodeShift::between(std::span<const double> codes, std::span<const double> wanted) {
  constexpr int kTimesEach = 4;
  // Codes of one place stray, by shadows too. Followed more closely, that would be taken for a bent curve.
  constexpr double kMinReach = 4;
  CodeShift shift;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    if (tells_exposure(codes[i], wanted[i])) ratios.push_back(wanted[i] / std::max(codes[i], kCode8));
  }
  const std::size_t telling = ratios.size();
  if (kMaxSilent * telling < codes.size()) return shift;
  const double ratio = median(ratios);
  std::vector<double> left(codes.size()), sizes(codes.size());
  for (std::size_t knot = 0; knot < kKnots; ++knot) {
    shift.shifts_[knot] = (ratio - 1) * static_cast<double>(knot) / (kKnots - 1);
  }
  double deviation = 0;
  for (double reach = kKnots - 1; reach >= kMinReach; reach /= 2) {
    for (int time = 0; time < kTimesEach; ++time) {
      for (std::size_t i = 0; i < codes.size(); ++i) {
        left[i] = wanted[i] - codes[i] - shift.at(codes[i]);
        sizes[i] = std::abs(left[i]);
      }
      deviation = std::max(1.4826 * median(sizes), kCode8);
      // Sorted to fractions of a knot first: weights and weighted sums.
      constexpr std::size_t kParts = 4;
      std::array<double, kParts*(kKnots - 1) + 1> weights{}, strays{}, sums{};
      for (std::size_t i = 0; i < codes.size(); ++i) {
        const double weight = trust(left[i], deviation);
        const auto part =
            static_cast<std::size_t>(std::lround(std::min(codes[i], 1.0) * (weights.size() - 1)));
        weights[part] += weight;
        strays[part] += 1 - weight;
        sums[part] += weight * left[i];
      }
      // So many pairs count as much as what is known already.
      const double known = static_cast<double>(codes.size()) / 500;
      for (std::size_t knot = 0; knot < kKnots; ++knot) {
        double weight = known, sum = 0;
        for (std::size_t part = 0; part < weights.size(); ++part) {
          const double away =
              std::abs(static_cast<double>(part) / kParts - static_cast<double>(knot)) / (reach + 1);
          const double near = std::max(1 - away, 0.0);
          weight += near * (weights[part] + strays[part]);
          sum += near * sums[part];
        }
        shift.shifts_[knot] += sum / weight;
      }
    }
  }
  std::size_t trusted = 0;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    trusted += tells_exposure(codes[i], wanted[i]) && trust(left[i], deviation) > 0 ? 1 : 0;
  }
  constexpr double kMaxDeviation = 12 * kCode8;
  if (deviation > kMaxDeviation || 2 * trusted < telling) return std::nullopt;
  for (std::size_t knot = 1; knot < kKnots; ++knot) {
    const double slope = 1 + (shift.shifts_[knot] - shift.shifts_[knot - 1]) * (kKnots - 1);
    if (slope < 1.0 / kSteepest || slope > kSteepest) return std::nullopt;
  }
  return shift;
}

double CodeShift::at(double code) const {
  const double place = std::clamp(code, 0.0, 1.0) * (kKnots - 1);
  const auto knot = std::min(static_cast<std::size_t>(place), kKnots - 2);
  const double share = place - static_cast<double>(knot);
  return (1 - share) * shifts_[knot] + share * shifts_[knot + 1];
}

double CodeShift::distance_to(const CodeShift& other, std::span<const double> codes) const {
  std::vector<double> distances;
  for (const double code : codes) distances.push_back(std::abs(at(code) - other.at(code)));
  const auto rare = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / kMaxSilent);
  std::nth_element(distances.begin(), rare, distances.end(), std::greater<>());
  return *rare;
}

// For every λ, P(|Σ ±d| >= s) <= 2 exp(-λ s) Π cosh(λ d): least where Σ d tanh(λ d) = s.
bool may_be_chance(std::span<const double> differences, double trials) {
  double sum = 0, largest = 0;
  for (const double difference : differences) {
    sum += difference;
    largest = std::max(largest, std::abs(difference));
  }
  if (sum == 0) return true;
  double low = 0, high = 40 / largest;  // any will do
  double logarithm = 0;
  for (int step = 0; step < 24; ++step) {
    const double lambda = (low + high) / 2;
    double slope = -std::abs(sum);
    logarithm = std::numbers::ln2 - lambda * std::abs(sum);
    for (const double difference : differences) {
      const double size = lambda * std::abs(difference), tail = std::exp(-2 * size);
      slope += std::abs(difference) * (1 - tail) / (1 + tail);
      logarithm += size + std::log1p(tail) - std::numbers::ln2;
    }
    (slope < 0 ? low : high) = lambda;
  }
  return logarithm > -std::log(trials);
}

std::unique_ptr<Clip> deflicker(std::unique_ptr<Clip> clip) {
  return std::make_unique<DeflickeredClip>(std::move(clip));
}

}  // namespace nutik
