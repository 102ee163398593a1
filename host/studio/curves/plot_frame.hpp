// Where a time and a gain lie in the curve editor, in pixels.
#pragma once

#include <QPointF>
#include <QRectF>
#include <cstdint>

#include "studio/curves/gain_axis.hpp"
#include "studio/time/time_axis.hpp"

namespace nutik::studio {

class PlotFrame {
 public:
  // `box`: the area between the axes, in a widget of this width.
  PlotFrame(const TimeAxis& axis, int width, const QRectF& box, GainRange gains)
      : axis_(&axis), width_(width), box_(box), gains_(gains) {}

  [[nodiscard]] const QRectF& box() const { return box_; }
  [[nodiscard]] const GainRange& gains() const { return gains_; }
  [[nodiscard]] double ns_per_pixel() const { return axis_->ns_per_pixel(width_); }
  [[nodiscard]] double gain_per_pixel() const { return (gains_.high - gains_.low) / box_.height(); }

  [[nodiscard]] double x_of(std::int64_t time_ns) const {
    return axis_->to_pixel(static_cast<double>(time_ns), width_);
  }
  [[nodiscard]] std::int64_t time_at(double x) const { return axis_->to_time(x, width_); }
  [[nodiscard]] double y_of(double gain) const {
    return box_.bottom() - (gain - gains_.low) / gain_per_pixel();
  }
  [[nodiscard]] double gain_at(double y) const { return gains_.low + (box_.bottom() - y) * gain_per_pixel(); }
  [[nodiscard]] QPointF place(const ControlPoint& point) const {
    return {x_of(point.time_ns), y_of(point.gain)};
  }

 private:
  const TimeAxis* axis_;
  int width_;
  QRectF box_;
  GainRange gains_;
};

}  // namespace nutik::studio
