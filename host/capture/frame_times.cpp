#include "capture/frame_times.hpp"

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {
namespace {

constexpr std::int64_t kLargestFrameTerm = 1'000'000'000;  // keeps every product below 2^126
constexpr std::int64_t kFinestAngle = 1'000'000;
constexpr std::int64_t kLongestFrameNs = 1'000'000'000'000'000'000;

// Whole nanoseconds and what is left of them: 0 <= part < of.
struct Split {
  int128 whole;
  int128 part;
  int128 of;
};

Split split(int128 numerator, int128 denominator) {
  int128 whole = numerator / denominator;
  int128 part = numerator % denominator;
  if (part < 0) {
    part += denominator;
    --whole;
  }
  return {whole, part, denominator};
}

int128 common_divisor(int128 a, int128 b) {
  while (b != 0) {
    const int128 rest = a % b;
    a = b;
    b = rest;
  }
  return a;
}

void check_term(Rational value, const char* what) {
  if (value.numerator <= 0) throw UsageError(format("{} {} is not positive", what, value.text()));
  if (value.numerator > kLargestFrameTerm || value.denominator > kLargestFrameTerm) {
    throw UsageError(
        format("{} {} is written with more than nine digits above or below the fraction line, the "
               "most that times stay exact with",
               what, value.text()));
  }
}

}  // namespace

ExactTime ExactTime::of_sample(const Timeline& timeline, std::uint64_t k) {
  if (!timeline.is_constant()) return {timeline.start_ns(k), 1};
  const Rational rate = timeline.rate();
  return {static_cast<int128>(k) * rate.denominator * kSecondNs, rate.numerator};
}

ExactTime operator+(const ExactTime& a, const ExactTime& b) {
  constexpr int128 kFinest = 1'000'000'000'000'000;
  const Split of_a = split(a.numerator, a.denominator), of_b = split(b.numerator, b.denominator);
  int128 part = of_a.part * of_b.of + of_b.part * of_a.of, of = of_a.of * of_b.of;
  const int128 shared = common_divisor(part, of);
  part /= shared;
  of /= shared;
  if (of > kFinest) {
    part = static_cast<int128>(static_cast<long double>(part) / static_cast<long double>(of) *
                               static_cast<long double>(kFinest));
    of = kFinest;
  }
  return {(of_a.whole + of_b.whole) * of + part, of};
}

std::int64_t rounded_sum(const ExactTime& a, const ExactTime& b) {
  const Split of_a = split(a.numerator, a.denominator), of_b = split(b.numerator, b.denominator);
  return static_cast<std::int64_t>(of_a.whole + of_b.whole) +
         round_half_up(of_a.part * of_b.of + of_b.part * of_a.of, of_a.of * of_b.of);
}

std::int64_t rounded_between(const ExactTime& from, const ExactTime& to, std::int64_t step,
                             std::int64_t steps) {
  const Split a = split(from.numerator, from.denominator), b = split(to.numerator, to.denominator);
  const Split whole = split(a.whole * (steps - step) + b.whole * step, steps);
  const int128 part = whole.part * a.of * b.of + a.part * b.of * (steps - step) + b.part * a.of * step;
  return static_cast<std::int64_t>(whole.whole) + round_half_up(part, a.of * b.of * steps);
}

FrameTimes::FrameTimes(ExactTime from, Rational rate, Rational speed, Rational angle)
    : from_(from), angle_(angle) {
  check_term(rate, "frame rate");
  check_term(speed, "speed");
  if (angle.numerator <= 0) throw UsageError(format("shutter angle {} is not positive", angle.text()));
  if (angle.numerator > kLargestFrameTerm || angle.denominator > kFinestAngle) {
    throw UsageError(format("shutter angle {} has more than six decimals or nine digits", angle.text()));
  }
  period_s_ = Rational::of(speed.numerator * rate.denominator, speed.denominator * rate.numerator);
  if (period_s_.numerator > kLargestFrameTerm || period_s_.denominator > kLargestFrameTerm) {
    throw UsageError(
        format("{} frames a second at speed {} are {} s of the capture each: more digits than times "
               "stay exact with (nine above and below the fraction line)",
               rate.text(), speed.text(), period_s_.text()));
  }
  const int128 period_ns = static_cast<int128>(period_s_.numerator) * kSecondNs;
  const int128 whole_turn = static_cast<int128>(360) * angle.denominator * period_s_.denominator;
  if (period_ns < period_s_.denominator || period_ns * angle.numerator < whole_turn) {
    throw UsageError(
        format("{} frames a second at speed {} and {} degrees expose for less than 1 ns of the "
               "capture, the shortest time it knows",
               rate.text(), speed.text(), angle.text()));
  }
  if (period_ns / period_s_.denominator > kLongestFrameNs ||
      period_ns * angle.numerator / whole_turn > kLongestFrameNs) {
    throw UsageError(format("{} frames a second at speed {} and {} degrees expose for longer than 31 years",
                            rate.text(), speed.text(), angle.text()));
  }
}

std::int64_t FrameTimes::time_ns(std::uint64_t k, std::int64_t degrees) const {
  const int128 period_ns = static_cast<int128>(period_s_.numerator) * kSecondNs;
  const Split from = split(from_.numerator, from_.denominator);
  const Split frame = split(static_cast<int128>(k) * period_ns, period_s_.denominator);
  const Split open =
      split(period_ns * degrees, static_cast<int128>(360) * angle_.denominator * period_s_.denominator);
  // What is left, over the denominators' product: `open`'s is a multiple of `frame`'s.
  const int128 of = from.of * open.of;
  const int128 part = from.part * open.of + (frame.part * (open.of / frame.of) + open.part) * from.of;
  return static_cast<std::int64_t>(from.whole + frame.whole + open.whole) + round_half_up(part, of);
}

std::uint64_t FrameTimes::count_by(std::int64_t until_ns, std::int64_t degrees) const {
  if (time_ns(0, degrees) > until_ns) return 0;
  // Frame `low` is one of them. Times stay within 64 bits: none lies more than two periods after until_ns.
  const int128 period_ns = static_cast<int128>(period_s_.numerator) * kSecondNs;
  const auto span = static_cast<int128>(until_ns) - time_ns(0, degrees);
  std::uint64_t low = 0;
  auto high = static_cast<std::uint64_t>(span * period_s_.denominator / period_ns) + 2;
  while (high - low > 1) {
    const std::uint64_t middle = low + (high - low) / 2;
    (time_ns(middle, degrees) <= until_ns ? low : high) = middle;
  }
  return high;
}

std::uint64_t FrameTimes::count_ending_by(std::int64_t until_ns) const {
  return count_by(until_ns, angle_.numerator);
}

std::uint64_t FrameTimes::count_starting_by(std::int64_t until_ns) const { return count_by(until_ns, 0); }

}  // namespace nutik
