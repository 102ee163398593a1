// What the time strip and the curve editor have in common: colours, from the window's palette (dark windows have dark
// ones), a backdrop, and answers to events.
#pragma once

#include <QColor>
#include <QKeyEvent>
#include <QPalette>
#include <QPixmap>
#include <QPolygonF>
#include <QWheelEvent>
#include <QWidget>
#include <span>
#include <vector>

#include "studio/document/document.hpp"
#include "studio/time/time_axis.hpp"

namespace nutik::studio {

// `share` of b, the rest of a.
[[nodiscard]] QColor mixed(const QColor& a, const QColor& b, double share);
[[nodiscard]] QColor with_opacity(QColor colour, double opacity);

struct TimeColours {
  QColor ground;   // behind everything
  QColor outside;  // before the capture's start and after its end
  QColor grid, axis;
  QColor label, text;
  QColor activity, waveform;
  QColor negative;  // what takes light away
  QColor boxcar;    // the interval that is exposed, marks
  QColor guide;     // what a drag snapped to
  QColor warning;
  QColor tip, tip_text;  // coordinates

  // A region's colour as a line that can be seen on the ground.
  [[nodiscard]] QColor line(const QColor& region) const;

  static TimeColours of(const QPalette& palette);
};

// A number for each sample, seen from far: the least and the most of many samples at once, however many there are.
class Series {
 public:
  struct Range {
    double low = 0.0, high = 0.0;
  };

  Series() = default;
  explicit Series(std::vector<double> values);

  [[nodiscard]] std::span<const double> values() const { return values_; }
  [[nodiscard]] bool empty() const { return values_.empty(); }
  // The range of values [first, last), at least one.
  [[nodiscard]] Range over(std::size_t first, std::size_t last) const;

 private:
  static constexpr std::size_t kTogether = 256;

  std::vector<double> values_;
  std::vector<Range> coarse_;  // of kTogether values each
};

// For each pixel column of a widget what the series has there: from its highest value to its lowest. Columns without
// a sample are left out.
struct SeriesColumn {
  int x = 0;
  Series::Range range;
};
[[nodiscard]] std::vector<SeriesColumn> columns_of(const Series& series, const Timeline& timeline,
                                                   const TimeAxis& axis, int width);

// The series as an area from the bottom of `box`, whose top is `most`.
[[nodiscard]] QPolygonF area_of(const std::vector<SeriesColumn>& columns, const QRectF& box, double most);

class TimeView : public QWidget {
 public:
  // What is said of what lies at a place, as a tooltip; empty on empty ground.
  [[nodiscard]] virtual QString text_at(QPointF at) const = 0;

 protected:
  TimeView(Document& document, TimeAxis& axis, QWidget* parent);

  // Its own keys, whatever they are shortcuts of elsewhere.
  [[nodiscard]] virtual bool is_own_key(const QKeyEvent& event) const = 0;
  // Draws what seldom changes, after refresh_backdrop() alone.
  virtual void paint_backdrop(QPainter& painter, const TimeColours& colours) = 0;
  void refresh_backdrop();
  void draw_backdrop(QPainter& painter, const TimeColours& colours);

  // Some systems turn the wheel sideways while Shift or Alt is down.
  [[nodiscard]] static double notches_of(const QWheelEvent& event);

  // As long as a key is held it makes one step of undo, and the full picture follows when it is let go.
  void begin_key_edit(const QKeyEvent& event);
  void end_key_edit();

  bool event(QEvent* event) override;
  void changeEvent(QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;

  static constexpr double kPerNotch = 0.8;  // of what is seen

  Document& document_;
  TimeAxis& axis_;
  Series activity_;

 private:
  bool is_key_edit_ = false;
  QPixmap backdrop_;
  bool is_backdrop_stale_ = true;
};

}  // namespace nutik::studio
