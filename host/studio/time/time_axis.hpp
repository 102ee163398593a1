// The part of the capture's time that is visible, shared by the time strip and the curve editor so that they agree.
//
//   units:   nanoseconds from the capture's start; pixels within a widget of a given width
//   always:  begin_ns() < end_ns(); [begin, end] lies within a margin of the capture on both sides, so that points at
//            its very ends can be seen and reached
//
// The widgets leave kLeft pixels at the left for labels, and kRight at the right.
#pragma once

#include <QObject>
#include <cstdint>

namespace nutik::studio {

class TimeAxis : public QObject {
  Q_OBJECT

 public:
  static constexpr int kLeft = 74, kRight = 16;

  explicit TimeAxis(QObject* parent = nullptr) : QObject(parent) {}

  // A new capture's duration: all of it is shown.
  void set_duration(std::int64_t duration_ns);
  [[nodiscard]] std::int64_t duration_ns() const { return duration_ns_; }

  [[nodiscard]] double begin_ns() const { return begin_ns_; }
  [[nodiscard]] double end_ns() const { return end_ns_; }
  [[nodiscard]] double ns_per_pixel(int width) const;

  [[nodiscard]] double to_pixel(double time_ns, int width) const;
  // The nearest whole nanosecond; not clamped.
  [[nodiscard]] std::int64_t to_time(double x, int width) const;

  void show(double begin_ns, double end_ns);
  void show_all();
  // Shows `factor` times as much, and the time at x stays there.
  void zoom(double factor, double x, int width);
  // Moves what is shown by so many pixels to the left.
  void pan(double pixels, int width);

 Q_SIGNALS:
  void changed();  // what is shown

 private:
  [[nodiscard]] static int extent(int width);

  std::int64_t duration_ns_ = 1;
  double begin_ns_ = 0, end_ns_ = 1;
};

}  // namespace nutik::studio
