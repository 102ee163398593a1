// The gain functions over time: the selected region's to be drawn, the others' faintly behind.
//
//   mouse      drag a point, several selected ones, a side of the box round them, a boxcar's bar, its ends or its
//              level; click the curve for a new point, right-click a point to take it away; drag over empty ground to
//              select
//   modifiers  Shift: a tenth as fast. Ctrl: no snapping, and a step's point without the other one
//   wheel      zooms the time to the pointer; Shift: pans; Ctrl: zooms the gain; double click on the axis: automatic
//              again
//   keyboard   Tab, Home, End: from point to point. Arrows: by a sample or 0.1 of gain, Shift ten times that, Ctrl 1 ns
//              or 0.01. Delete, Insert, Return to type, Ctrl+A, Escape, + and - to zoom, F to show all
//
//   always:  edits go through the document, a drag as one step; Escape takes a drag back
#pragma once

#include <optional>

#include "studio/curves/curve_paint.hpp"
#include "studio/curves/drags.hpp"

namespace nutik::studio {

class NumberEditor;

class CurveEditor : public TimeView {
  Q_OBJECT

 public:
  CurveEditor(Document& document, TimeAxis& axis, QWidget* parent = nullptr);
  ~CurveEditor() override;

  [[nodiscard]] QSize sizeHint() const override { return {900, 260}; }
  [[nodiscard]] QSize minimumSizeHint() const override { return {320, 96}; }

  // Where things lie at the moment.
  [[nodiscard]] PlotFrame frame() const;
  [[nodiscard]] double lane_top() const;
  // What check says of the selected function.
  [[nodiscard]] const std::vector<FunctionFinding>& findings() const { return findings_; }
  [[nodiscard]] QString text_at(QPointF at) const override;

 protected:
  [[nodiscard]] bool is_own_key(const QKeyEvent& event) const override;
  void paint_backdrop(QPainter& painter, const TimeColours& colours) override;
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void focusInEvent(QFocusEvent* event) override;
  bool focusNextPrevChild(bool next) override;

 private:
  // What the button that is down does.
  struct Press {
    enum class Kind { drag, rubber_band, pan };
    Kind kind = Kind::drag;
    QPointF at;    // where it went down
    QPointF last;  // where the pointer was last
    QPointF hand;  // how far the hand has come, slowly with Shift
    std::optional<Drag> drag;
    std::uint8_t tag = 0;       // whose points are dragged
    bool has_moved = false;
    bool adds_point = false;                  // a click on the curve
    std::optional<std::size_t> toggles = {};  // of a click: a point to leave out of the selection
    PointIndices kept = {};                   // a rubber band adds to
  };

  void follow_document();
  void follow_selection();
  void refresh_findings();
  void describe();  // to screen readers
  void use(const Points& points, const QString& name);
  void select(const PointIndices& points, std::optional<std::size_t> current);
  [[nodiscard]] PointIndices selected() const;
  [[nodiscard]] Snapper snapper(const PointIndices& moved) const;
  [[nodiscard]] std::optional<TransformBox> box() const;
  [[nodiscard]] QRectF plot_area() const;
  [[nodiscard]] QString function_name() const;
  [[nodiscard]] QString pointer_text() const;  // where it is, or the point that it is on

  // Mouse.
  void press_point(std::size_t point, const QMouseEvent& event);
  void press_curve(QPointF at);
  void start(Drag drag, QPointF at);
  void drag_to(QPointF at, Qt::KeyboardModifiers modifiers);
  void cancel_press();
  void drop_press();
  void remove_at(QPointF at);
  void set_shape_at(QPointF at);

  // Keyboard.
  void nudge(std::int64_t samples, std::int64_t ns);
  void raise(double by);
  void remove_selected();
  void insert_point();
  void type_numbers();
  QString set_current(const ControlPoint& typed);  // or what is wrong with it
  void step_to(std::size_t point);
  bool edit_by_key(const QKeyEvent& event);
  bool look_by_key(const QKeyEvent& event);

  // Painting.
  void paint_header(QPainter& painter, const TimeColours& colours) const;
  void paint_drag(QPainter& painter, const PlotFrame& frame, const TimeColours& colours) const;

  GainAxis gains_;
  Points points_;  // of the selected function
  std::vector<GainBoxcar> boxcars_;
  std::vector<FunctionFinding> findings_;
  std::optional<std::size_t> current_;  // the keyboard's point
  std::optional<Press> press_;
  std::optional<Dragged> dragged_;
  std::optional<QPointF> hovered_;
  QString message_;  // why nothing happened; until the next edit
  NumberEditor* numbers_ = nullptr;

  FunctionSet drawn_functions_;  // that the backdrop was made for
  Series waveform_;
};

}  // namespace nutik::studio
