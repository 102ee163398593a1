// When each sample of a capture was exposed, in whole nanoseconds from the start of the capture.
//
//   in:      a constant rate and shutter angle, a list of start times, or a list of exposures
//   out:     [start_ns(k), end_ns(k)] for k = 0 … sample_count() - 1, and the domain [0, duration_ns()]
//   always:  0 = start_ns(0), start_ns(k) < end_ns(k) <= start_ns(k + 1), end_ns(N - 1) <= duration_ns()
//
// Nothing outside this class may assume a constant rate. A constant timeline holds no table, so a day at
// 1000 samples a second costs nothing.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "capture/rational.hpp"

namespace nutik {

// Samples [first, last). Empty where first == last.
struct SampleRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;

  [[nodiscard]] std::uint64_t size() const { return last - first; }
  [[nodiscard]] bool empty() const { return first == last; }
  // Reaches over another one, too, and over what lies between.
  void cover(const SampleRange& other) {
    if (other.empty()) return;
    *this = empty() ? other : SampleRange{std::min(first, other.first), std::max(last, other.last)};
  }
  friend bool operator==(const SampleRange&, const SampleRange&) = default;
};

struct Exposure {
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
  friend bool operator==(const Exposure&, const Exposure&) = default;
};

// Everything the light at a sample depends on: its exposure [start_ns, end_ns] and its reach, where its
// value has any say, [before_ns, after_ns]. before <= start < end <= after.
struct SampleTimes {
  std::int64_t before_ns = 0;
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
  std::int64_t after_ns = 0;
};

class Timeline {
 public:
  static constexpr Rational kFullShutter{360, 1};

  // s_k = round(k / rate), e_k = round((k + angle/360) / rate), duration = round(N / rate), each rounded
  // half up from its own exact value. rate in samples a second, angle in degrees. Throws UsageError
  // where the rate is not positive, the angle is not in (0, 360], an exposure would be shorter than
  // 1 ns, or the capture longer than 2^62 ns (146 years).
  static Timeline constant(Rational rate, Rational shutter_angle, std::uint64_t sample_count);

  // e_k = s_k + angle/360 · (s_(k+1) - s_k), the last period equal to the one before; times are shifted
  // so that the first is 0. Throws InputError naming the first sample whose time does not increase, or
  // where one sample gives no period, and like those below where the capture is longer than 2^62 ns.
  static Timeline irregular(std::vector<std::int64_t> starts_ns, Rational shutter_angle);

  // Exposures as given, shifted so that the first starts at 0; the capture ends with the last one.
  // Throws InputError naming the first sample that ends before it starts or overlaps the one before.
  static Timeline explicit_exposures(std::vector<Exposure> exposures);

  // Exposures that start at 0, and a domain that may go on after the last one: a timeline that was
  // stored. Throws InputError as above, or where the domain ends before the last exposure.
  static Timeline stored(std::vector<Exposure> exposures, std::int64_t duration_ns, Rational shutter_angle);

  [[nodiscard]] std::uint64_t sample_count() const { return sample_count_; }
  [[nodiscard]] std::int64_t duration_ns() const { return duration_ns_; }
  [[nodiscard]] std::int64_t start_ns(std::uint64_t k) const;
  [[nodiscard]] std::int64_t end_ns(std::uint64_t k) const;

  // Sample k's reach: from the end of the exposure before (0 for the first) to the start of the one
  // after (the end of the capture for the last).
  [[nodiscard]] std::int64_t reach_begin_ns(std::uint64_t k) const { return k == 0 ? 0 : end_ns(k - 1); }
  [[nodiscard]] std::int64_t reach_end_ns(std::uint64_t k) const {
    return k + 1 == sample_count_ ? duration_ns_ : start_ns(k + 1);
  }

  [[nodiscard]] SampleTimes times(std::uint64_t k) const {
    return {reach_begin_ns(k), start_ns(k), end_ns(k), reach_end_ns(k)};
  }
  [[nodiscard]] std::vector<SampleTimes> times(SampleRange samples) const;

  // The samples whose reach meets [begin_ns, end_ns] in more than a point.
  [[nodiscard]] SampleRange samples_reaching(std::int64_t begin_ns, std::int64_t end_ns) const;

  // Empty for a constant timeline; otherwise every exposure.
  [[nodiscard]] std::span<const Exposure> table() const { return exposures_; }
  [[nodiscard]] bool is_constant() const { return exposures_.empty(); }

  // Samples a second, above 0: exact where constant, else the mean from the first start to the last. The angle that a
  // constant or irregular timeline was made with; for explicit exposures the mean share of the period, in degrees.
  [[nodiscard]] Rational rate() const { return rate_; }
  [[nodiscard]] Rational shutter_angle() const { return shutter_angle_; }

  // These times, of samples that were made between pictures and of the pictures that were filmed, whose own times have
  // no regard to what was made.
  [[nodiscard]] Timeline with_pictures(Timeline filmed) const;
  // Times of the pictures that were filmed, which `12f` counts: these, where no samples were made between them.
  [[nodiscard]] const Timeline& pictures() const { return filmed_ ? *filmed_ : *this; }
  // The sample that a picture is; the picture that a sample is, none where it was made.
  [[nodiscard]] std::uint64_t sample_of(std::uint64_t picture) const;
  [[nodiscard]] std::optional<std::uint64_t> picture_of(std::uint64_t sample) const;

  friend bool operator==(const Timeline& a, const Timeline& b);

 private:
  Timeline() = default;

  Rational rate_{1, 1};
  Rational shutter_angle_ = kFullShutter;
  std::uint64_t sample_count_ = 0;
  std::int64_t duration_ns_ = 0;
  std::vector<Exposure> exposures_;
  std::shared_ptr<const Timeline> filmed_;  // null: all samples were
};

}  // namespace nutik
