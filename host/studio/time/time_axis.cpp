#include "studio/time/time_axis.hpp"

#include <algorithm>
#include <cmath>

namespace nutik::studio {
namespace {

constexpr double kMargin = 0.02;      // of the capture, beyond each end
constexpr double kMinShownNs = 20;  // steps of 1 ns stand for jumps: they can be looked at

}  // namespace

int TimeAxis::extent(int width) { return std::max(width - kLeft - kRight, 1); }

void TimeAxis::set_duration(std::int64_t duration_ns) {
  duration_ns_ = std::max<std::int64_t>(duration_ns, 1);
  begin_ns_ = end_ns_ = 0;
  show_all();
}

double TimeAxis::ns_per_pixel(int width) const { return (end_ns_ - begin_ns_) / extent(width); }

double TimeAxis::to_pixel(double time_ns, int width) const {
  return kLeft + (time_ns - begin_ns_) / ns_per_pixel(width);
}

std::int64_t TimeAxis::to_time(double x, int width) const {
  return std::llround(begin_ns_ + (x - kLeft) * ns_per_pixel(width));
}

void TimeAxis::show(double begin_ns, double end_ns) {
  const auto duration = static_cast<double>(duration_ns_);
  const double margin = kMargin * duration;
  const double length =
      std::clamp(end_ns - begin_ns, std::min(kMinShownNs, duration), duration + 2 * margin);
  const double begin = std::max(-margin, std::min(begin_ns, duration + margin - length));  // which rounding may cross
  if (begin == begin_ns_ && begin + length == end_ns_) return;
  begin_ns_ = begin;
  end_ns_ = begin + length;
  Q_EMIT changed();
}

void TimeAxis::show_all() {
  const double margin = kMargin * static_cast<double>(duration_ns_);
  show(-margin, static_cast<double>(duration_ns_) + margin);
}

void TimeAxis::zoom(double factor, double x, int width) {
  const double fixed_ns = begin_ns_ + (x - kLeft) * ns_per_pixel(width);
  show(fixed_ns + (begin_ns_ - fixed_ns) * factor, fixed_ns + (end_ns_ - fixed_ns) * factor);
}

void TimeAxis::pan(double pixels, int width) {
  const double by_ns = pixels * ns_per_pixel(width);
  show(begin_ns_ + by_ns, end_ns_ + by_ns);
}

}  // namespace nutik::studio
