#include "support/exact.hpp"

#include <algorithm>
#include <cmath>

namespace nutik::test {
namespace {

Exact magnitude(const Exact& value) { return value < 0 ? Exact(-value) : value; }

}  // namespace

double error_in(const Exact& scale, double value, const Exact& exact) {
  if (!std::isfinite(value)) return INFINITY;
  const Exact error = Exact(value) - exact;
  if (scale == 0) return error == 0 ? 0.0 : INFINITY;
  return std::fabs(Exact(error / scale).convert_to<double>());
}

std::int64_t rounded_half_up(const Exact& value) {
  const Exact shifted = value + Exact(1, 2);
  boost::multiprecision::cpp_int quotient = numerator(shifted) / denominator(shifted);
  if (quotient * denominator(shifted) > numerator(shifted)) --quotient;
  return static_cast<std::int64_t>(quotient);
}

std::int64_t exact_course_support_ns(const GainFunction& function, std::int64_t duration_ns) {
  const auto points = function.points();
  const auto held = [&](double gain, std::int64_t begin_ns, std::int64_t end_ns) {
    const std::int64_t held_ns = std::min(end_ns, duration_ns) - std::max<std::int64_t>(begin_ns, 0);
    return gain == 0.0 ? 0 : std::max<std::int64_t>(0, held_ns);
  };
  std::int64_t support_ns = held(points.front().gain, 0, points.front().time_ns) +
                            held(points.back().gain, points.back().time_ns, duration_ns);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if (points[i].gain != 0.0 || points[i + 1].gain != 0.0)
      support_ns += points[i + 1].time_ns - points[i].time_ns;
  }
  return support_ns;
}

std::vector<ExactStretch> exact_gain(const GainFunction& function, std::int64_t duration_ns,
                                     std::int64_t delay_ns) {
  std::vector<ExactStretch> stretches;
  const auto points = function.points();
  const std::int64_t first_ns = points.front().time_ns + delay_ns;
  const std::int64_t last_ns = points.back().time_ns + delay_ns;
  const auto add = [&](std::int64_t begin, std::int64_t end, double from, double to) {
    const std::int64_t inside_begin = std::max<std::int64_t>(begin, 0);
    const std::int64_t inside_end = std::min(end, duration_ns);
    if (inside_begin >= inside_end) return;
    const ExactStretch whole{begin, end, Exact(from), Exact(to)};
    stretches.push_back({inside_begin, inside_end, whole.at(inside_begin), whole.at(inside_end)});
  };
  add(std::min<std::int64_t>(first_ns, 0) - 1, first_ns, function.first_gain(), function.first_gain());
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if (points[i].time_ns == points[i + 1].time_ns) continue;
    add(points[i].time_ns + delay_ns, points[i + 1].time_ns + delay_ns, points[i].gain, points[i + 1].gain);
  }
  add(last_ns, std::max(last_ns, duration_ns) + 1, function.last_gain(), function.last_gain());
  return stretches;
}

std::vector<ExactStretch>::const_iterator first_stretch_after(const std::vector<ExactStretch>& stretches,
                                                              std::int64_t time_ns) {
  return std::partition_point(stretches.begin(), stretches.end(),
                              [&](const ExactStretch& stretch) { return stretch.end_ns <= time_ns; });
}

Exact integrate_product(const std::vector<ExactStretch>& a, const std::vector<ExactStretch>& b) {
  Exact sum = 0;
  for (const ExactStretch& left : a) {
    for (auto right = first_stretch_after(b, left.begin_ns);
         right != b.end() && right->begin_ns < left.end_ns; ++right) {
      const std::int64_t from = std::max(left.begin_ns, right->begin_ns);
      const std::int64_t to = std::min(left.end_ns, right->end_ns);
      if (from >= to || left.is_zero() || right->is_zero()) continue;
      const Exact start = left.at(from) * right->at(from);
      const Exact end = left.at(to) * right->at(to);
      const Exact middle = (left.at(from) + left.at(to)) * (right->at(from) + right->at(to));
      sum += Exact(to - from) * (start + middle + end) / 6;  // middle: 4 · half · half
    }
  }
  return sum;
}

ExactSummary exact_summary(const std::vector<ExactStretch>& gain) {
  ExactSummary summary;
  for (const ExactStretch& stretch : gain) {
    if (stretch.is_zero()) continue;
    const std::int64_t length = stretch.end_ns - stretch.begin_ns;
    summary.support_ns += length;
    summary.integral_ns += Exact(length) * (stretch.begin + stretch.end) / 2;
    const Exact begin = magnitude(stretch.begin);
    const Exact end = magnitude(stretch.end);
    if (stretch.begin * stretch.end < 0) {  // two triangles
      const Exact triangles = Exact(length) * (begin * begin + end * end) / (2 * (begin + end));
      summary.absolute_integral_ns += Exact(boost::multiprecision::cpp_bin_float_100(triangles));
    } else {
      summary.absolute_integral_ns += Exact(length) * (begin + end) / 2;
    }
  }
  return summary;
}

std::vector<ExactStretch> magnitude_of(std::vector<ExactStretch> gain) {
  for (ExactStretch& stretch : gain) {
    stretch.begin = magnitude(stretch.begin);
    stretch.end = magnitude(stretch.end);
  }
  return gain;
}

std::vector<ExactStretch> exact_hat(const Timeline& timeline, std::uint64_t k) {
  std::vector<ExactStretch> hat;
  const bool is_last = k + 1 == timeline.sample_count();
  const auto add = [&](std::int64_t begin, std::int64_t end, int from, int to) {
    if (begin < end) hat.push_back({begin, end, Exact(from), Exact(to)});
  };
  if (k > 0) add(timeline.end_ns(k - 1), timeline.start_ns(k), 0, 1);
  add(timeline.start_ns(k), timeline.end_ns(k), 1, 1);
  add(timeline.end_ns(k), is_last ? timeline.duration_ns() : timeline.start_ns(k + 1), 1, is_last ? 1 : 0);
  return hat;
}

Exact exact_weight_ns(const std::vector<ExactStretch>& gain, const Timeline& timeline, std::uint64_t k) {
  return integrate_product(exact_hat(timeline, k), gain);
}

}  // namespace nutik::test
