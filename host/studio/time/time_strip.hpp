// The capture along time: what changes when, small pictures, and the interval that is exposed while it is scrubbed over
// it.
//
//   ruler      ticks; the in and out marks, which are dragged, and taken away by a right click
//   track      thumbnails and activity; the boxcar: pressed inside it is moved, at its ends it is made longer or
//              shorter, elsewhere it comes to the pointer
//   modifiers  Shift: a tenth as fast. Ctrl: not drawn to samples
//   wheel      zooms to the pointer; Shift: pans; the middle button pans, too
//   keyboard   Left and Right: by a sample, Shift: ten, Ctrl: 1 ns. Up and Down: longer and shorter by a sample.
//              Home, End. I and O: marks at the boxcar's ends, with Shift: none. X: the boxcar from mark to mark.
//              Z: shows what lies between the marks, or the boxcar. F: shows all. + and -: zoom
//
//   always:  a drag of the boxcar is one step of undo; Escape takes it back
#pragma once

#include <optional>

#include "studio/time/time_view.hpp"

namespace nutik::studio {

class TimeStrip : public TimeView {
  Q_OBJECT

 public:
  TimeStrip(Document& document, TimeAxis& axis, QWidget* parent = nullptr);

  [[nodiscard]] QSize sizeHint() const override { return {900, 92}; }
  [[nodiscard]] QSize minimumSizeHint() const override { return {320, 90}; }

  // Places of things, for whoever presses on them.
  [[nodiscard]] QRectF track() const;
  [[nodiscard]] QRectF boxcar_area() const;
  [[nodiscard]] QPointF mark_place(std::int64_t time_ns) const;
  [[nodiscard]] QString text_at(QPointF at) const override;

 protected:
  [[nodiscard]] bool is_own_key(const QKeyEvent& event) const override;
  void paint_backdrop(QPainter& painter, const TimeColours& colours) override;
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  enum class Part { none, whole, begin, end, mark_in, mark_out, pan };
  struct Press {
    Part part = Part::none;
    QPointF at, last;
    double hand_ns = 0.0;  // how far the hand has come, slowly with Shift
    Boxcar from;           // the boxcar that it began with
    std::optional<std::int64_t> mark_in, mark_out;
    bool edits = false;  // the document has been told of a drag
  };

  [[nodiscard]] Part part_at(QPointF at) const;
  [[nodiscard]] std::int64_t held(std::int64_t time_ns, Qt::KeyboardModifiers modifiers) const;
  void drag_to(QPointF at, Qt::KeyboardModifiers modifiers);
  void use(const Boxcar& boxcar, ExposureMode mode = ExposureMode::boxcar);
  void cancel_press();
  bool move_by_key(const QKeyEvent& event);
  bool look_by_key(const QKeyEvent& event);
  [[nodiscard]] QRectF place_of(const Boxcar& boxcar) const;
  void follow_document();
  void paint_thumbnails(QPainter& painter, const QRectF& row) const;
  void paint_boxcar(QPainter& painter, const TimeColours& colours) const;
  void paint_marks(QPainter& painter, const TimeColours& colours) const;

  std::optional<Press> press_;
};

// `100 ms to 110 ms, pictures 100 to 109`: an interval, for people.
[[nodiscard]] QString interval_text(const Boxcar& boxcar, const Timeline& timeline);

}  // namespace nutik::studio
