#include "capture/timeline.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {
namespace {

constexpr std::int64_t kLongestNs = std::int64_t{1} << 62;
constexpr std::int64_t kLargestTerm = 1'000'000'000;  // keeps every product below 2^126

void check_angle(Rational angle) {
  if (angle.numerator <= 0 || angle.numerator > 360 * angle.denominator) {
    throw UsageError(format("shutter angle {} is outside 0 < angle <= 360 degrees", angle.text()));
  }
  if (angle.denominator > 1'000'000) {
    throw UsageError(format("shutter angle {} has more than six decimals", angle.text()));
  }
}

// sample_index periods and `angle` degrees, in nanoseconds, rounded half up from the exact value.
std::int64_t constant_time_ns(Rational rate, Rational angle, std::uint64_t sample_index) {
  const int128 degrees = static_cast<int128>(sample_index) * 360 * angle.denominator + angle.numerator;
  return round_half_up(degrees * rate.denominator * kSecondNs,
                       static_cast<int128>(360) * angle.denominator * rate.numerator);
}

constexpr Rational kNoDegrees{0, 1};

// Samples a second: a mean, for people to read. To a thousandth, or of slower ones one in so many milliseconds.
Rational mean_rate(std::uint64_t periods, std::int64_t length_ns) {
  const auto count = static_cast<int128>(periods);
  if (count * kSecondNs >= length_ns) return Rational::of(round_half_up(count * kSecondNs * 1000, length_ns), 1000);
  return Rational::of(1000, round_half_up(length_ns, count * (kSecondNs / 1000)));
}

// From `origin`, where sample k is; both may be any numbers at all.
std::int64_t time_from(std::int64_t origin, std::int64_t time_ns, std::uint64_t k) {
  const int128 from = static_cast<int128>(time_ns) - origin;
  if (from <= kLongestNs && from >= -kLongestNs) return static_cast<std::int64_t>(from);
  throw InputError(
      format("sample {} is more than 146 years from the first, which is longer than a capture lasts", k));
}

}  // namespace

Timeline Timeline::constant(Rational rate, Rational shutter_angle, std::uint64_t sample_count) {
  if (rate.numerator <= 0 || rate.denominator <= 0) {
    throw UsageError(format("frame rate {} is not positive", rate.text()));
  }
  if (rate.numerator > kLargestTerm || rate.denominator > kLargestTerm) {
    throw UsageError(
        format("frame rate {} is written with more than nine digits above or below the "
               "fraction line, the most that times stay exact with",
               rate.text()));
  }
  check_angle(shutter_angle);
  const double duration = static_cast<double>(sample_count) / rate.value() * static_cast<double>(kSecondNs);
  if (!(duration < static_cast<double>(kLongestNs))) {
    throw UsageError(
        format("{} samples at {} a second last longer than 146 years", sample_count, rate.text()));
  }
  if (static_cast<int128>(shutter_angle.numerator) * rate.denominator * kSecondNs <
      static_cast<int128>(360) * shutter_angle.denominator * rate.numerator) {
    throw UsageError(
        format("a shutter angle of {} degrees at {} samples a second exposes for less than "
               "1 ns, the shortest time a capture knows",
               shutter_angle.text(), rate.text()));
  }
  Timeline timeline;
  timeline.rate_ = rate;
  timeline.shutter_angle_ = shutter_angle;
  timeline.sample_count_ = sample_count;
  timeline.duration_ns_ = constant_time_ns(rate, kNoDegrees, sample_count);
  return timeline;
}

Timeline Timeline::irregular(std::vector<std::int64_t> starts_ns, Rational shutter_angle) {
  check_angle(shutter_angle);
  if (starts_ns.size() < 2) {
    throw InputError("one timestamp gives no sample period; state the rate", {Setting::frame_rate});
  }
  const std::size_t count = starts_ns.size();
  std::vector<Exposure> exposures(count);
  for (std::size_t k = 0; k < count; ++k) {
    exposures[k].start_ns = time_from(starts_ns[0], starts_ns[k], k);
    if (k > 0 && starts_ns[k] <= starts_ns[k - 1]) {
      throw InputError(
          format("sample {} starts at {} ns, not after sample {} at {} ns; if they were taken at a "
                 "constant rate, state it",
                 k, starts_ns[k], k - 1, starts_ns[k - 1]),
          {Setting::frame_rate});
    }
  }
  const std::int64_t last_period = exposures[count - 1].start_ns - exposures[count - 2].start_ns;
  if (last_period > kLongestNs - exposures.back().start_ns) {
    throw InputError(format("the capture's {} samples last longer than 146 years", count));
  }
  const std::int64_t duration_ns = exposures.back().start_ns + last_period;
  for (std::size_t k = 0; k < count; ++k) {
    const std::int64_t next_ns = k + 1 < count ? exposures[k + 1].start_ns : duration_ns;
    const std::int64_t exposed =
        round_half_up(static_cast<int128>(next_ns - exposures[k].start_ns) * shutter_angle.numerator,
                      static_cast<int128>(360) * shutter_angle.denominator);
    exposures[k].end_ns = exposures[k].start_ns + std::max<std::int64_t>(exposed, 1);
  }
  return stored(std::move(exposures), duration_ns, shutter_angle);
}

Timeline Timeline::stored(std::vector<Exposure> exposures, std::int64_t duration_ns, Rational shutter_angle) {
  Timeline timeline = explicit_exposures(std::move(exposures));
  if (duration_ns < timeline.duration_ns_) {
    throw InputError(format("the capture ends at {} ns, before its last exposure at {} ns", duration_ns,
                            timeline.duration_ns_));
  }
  if (duration_ns > kLongestNs) {
    throw InputError(format("the capture ends at {} ns; 146 years are the most that one lasts", duration_ns));
  }
  timeline.duration_ns_ = duration_ns;
  if (timeline.sample_count_ == 1) timeline.rate_ = mean_rate(1, duration_ns);
  timeline.shutter_angle_ = shutter_angle;
  return timeline;
}

Timeline Timeline::explicit_exposures(std::vector<Exposure> exposures) {
  if (exposures.empty()) throw InputError("a capture needs at least one sample");
  const std::int64_t origin = exposures.front().start_ns;
  std::int64_t exposed_ns = 0;
  for (std::size_t k = 0; k < exposures.size(); ++k) {
    Exposure& exposure = exposures[k];
    if (exposure.end_ns <= exposure.start_ns) {
      throw InputError(format("sample {} ends at {} ns, not after its start at {} ns", k, exposure.end_ns,
                              exposure.start_ns));
    }
    exposure.start_ns = time_from(origin, exposure.start_ns, k);
    exposure.end_ns = time_from(origin, exposure.end_ns, k);
    if (k > 0 && exposure.start_ns < exposures[k - 1].end_ns) {
      throw InputError(
          format("sample {} starts at {} ns, before sample {} ends at {} ns (times from the "
                 "first sample)",
                 k, exposure.start_ns, k - 1, exposures[k - 1].end_ns));
    }
    if (k == 0 || k + 1 < exposures.size()) exposed_ns += exposure.end_ns - exposure.start_ns;
  }
  Timeline timeline;
  timeline.sample_count_ = exposures.size();
  timeline.duration_ns_ = exposures.back().end_ns;
  // Nobody says how long the last sample's period is, unless it is the only one.
  const std::uint64_t periods = std::max<std::uint64_t>(exposures.size() - 1, 1);
  const std::int64_t length_ns = exposures.size() > 1 ? exposures.back().start_ns : timeline.duration_ns_;
  timeline.rate_ = mean_rate(periods, length_ns);
  timeline.shutter_angle_ =
      Rational::of(round_half_up(static_cast<int128>(exposed_ns) * 360'000, length_ns), 1000);
  timeline.exposures_ = std::move(exposures);
  return timeline;
}

std::int64_t Timeline::start_ns(std::uint64_t k) const {
  return is_constant() ? constant_time_ns(rate_, kNoDegrees, k) : exposures_[k].start_ns;
}

std::int64_t Timeline::end_ns(std::uint64_t k) const {
  return is_constant() ? constant_time_ns(rate_, shutter_angle_, k) : exposures_[k].end_ns;
}

std::vector<SampleTimes> Timeline::times(SampleRange samples) const {
  std::vector<SampleTimes> times;
  times.reserve(samples.size());
  if (samples.empty()) return times;
  // Neighbours share what each is a division to find.
  SampleTimes next = this->times(samples.first);
  for (std::uint64_t k = samples.first; k < samples.last; ++k) {
    times.push_back(next);
    if (k + 1 < samples.last) next = {next.end_ns, next.after_ns, end_ns(k + 1), reach_end_ns(k + 1)};
  }
  return times;
}

SampleRange Timeline::samples_reaching(std::int64_t begin_ns, std::int64_t end_ns) const {
  if (begin_ns >= end_ns || begin_ns >= duration_ns_ || end_ns <= 0) return {};
  // Both ends of a sample's reach grow with k, so both borders are found by bisection.
  const auto first_where = [this](auto holds) {
    std::uint64_t low = 0, high = sample_count_;
    while (low < high) {
      const std::uint64_t middle = low + (high - low) / 2;
      if (holds(middle)) {
        high = middle;
      } else {
        low = middle + 1;
      }
    }
    return low;
  };
  const std::uint64_t first = first_where([&](std::uint64_t k) { return reach_end_ns(k) > begin_ns; });
  const std::uint64_t last = first_where([&](std::uint64_t k) { return reach_begin_ns(k) >= end_ns; });
  return first < last ? SampleRange{first, last} : SampleRange{};
}

Timeline Timeline::with_pictures(Timeline filmed) const {
  Timeline timeline = *this;
  timeline.filmed_ = std::make_shared<const Timeline>(std::move(filmed));
  return timeline;
}

std::uint64_t Timeline::sample_of(std::uint64_t picture) const {
  if (!filmed_) return picture;
  // What is left of its exposure lies round the middle.
  const std::int64_t middle_ns = std::midpoint(filmed_->start_ns(picture), filmed_->end_ns(picture));
  return samples_reaching(middle_ns, middle_ns + 1).first;
}

std::optional<std::uint64_t> Timeline::picture_of(std::uint64_t sample) const {
  if (!filmed_) return sample;
  const std::int64_t middle_ns = std::midpoint(start_ns(sample), end_ns(sample));
  const std::uint64_t picture = filmed_->samples_reaching(middle_ns, middle_ns + 1).first;
  return sample_of(picture) == sample ? std::optional(picture) : std::nullopt;
}

bool operator==(const Timeline& a, const Timeline& b) {
  const auto times = [](const Timeline& of) {
    return std::tie(of.rate_, of.shutter_angle_, of.sample_count_, of.duration_ns_, of.exposures_);
  };
  if (times(a) != times(b) || !a.filmed_ != !b.filmed_) return false;
  return a.filmed_ == b.filmed_ || *a.filmed_ == *b.filmed_;
}

}  // namespace nutik
