// The canvas's mouse and keyboard.
#include <QKeyEvent>
#include <QMouseEvent>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

#include "studio/canvas/picture_canvas.hpp"

namespace nutik::studio {
namespace {

constexpr double kClickPixels = 3;  // a press that moves no further is a click
constexpr double kPanByKey = 48;    // widget pixels
constexpr double kZoomByKey = 1.25;
constexpr double kZoomByNotch = 1.2;  // of a mouse wheel
constexpr int kFastPixels = 10;       // of the picture, with Shift

// The middle of the pixel there.
QPointF middle_of(QPointF at) { return {std::floor(at.x()) + 0.5, std::floor(at.y()) + 0.5}; }

// Where an arrow key leads, in pixels; null for other keys.
QPoint way_of(const QKeyEvent& event) {
  const int by = (event.modifiers() & Qt::ShiftModifier) != 0 ? kFastPixels : 1;
  switch (event.key()) {
    case Qt::Key_Left: return {-by, 0};
    case Qt::Key_Right: return {by, 0};
    case Qt::Key_Up: return {0, -by};
    case Qt::Key_Down: return {0, by};
    default: return {};
  }
}

}  // namespace

std::optional<QPoint> Canvas::pixel_at(QPointF widget) const {
  const QPointF at = view_.to_picture(widget);
  const QPoint pixel(static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y())));
  return image_.rect().contains(pixel) ? std::optional(pixel) : std::nullopt;
}

void Canvas::resizeEvent(QResizeEvent*) {
  view_.set_sizes(view_.picture(), size());
  view_moved();
}

bool Canvas::is_workable() const {
  return !image_.isNull() && document_.facts() != nullptr && !is_first_look_;
}

void Canvas::mousePressEvent(QMouseEvent* event) {
  pointer_ = pressed_ = event->position();
  is_inside_ = true;
  has_moved_ = false;
  is_by_keys_ = false;
  if (!is_workable() || is_stroking_) return;
  if (event->button() == Qt::MiddleButton || (event->button() == Qt::LeftButton && tool_ == nullptr)) {
    is_panning_ = true;
  } else if (event->button() == Qt::LeftButton) {
    is_stroking_ = true;
    tool_->press(view_.to_picture(pointer_), event->modifiers());
    update();
  }
}

void Canvas::mouseMoveEvent(QMouseEvent* event) {
  const QPointF before = pointer_;
  pointer_ = event->position();
  const bool was_here = is_inside_ && !is_by_keys_;
  is_inside_ = true;
  is_by_keys_ = false;
  if (is_panning_) {
    if (!has_moved_ && (pointer_ - pressed_).manhattanLength() <= kClickPixels) return;
    view_.pan(pointer_ - (has_moved_ ? before : pressed_));
    has_moved_ = true;
    view_moved();
  } else if (is_stroking_) {
    tool_->drag(view_.to_picture(pointer_), event->modifiers());
  }
  if (glance_.is_magnified) update();
  if (tool_ != nullptr && !is_panning_) was_here ? update_tool(before) : update();
  Q_EMIT pointed(pixel_at(pointer_));
}

void Canvas::mouseReleaseEvent(QMouseEvent* event) {
  if (is_panning_) {
    is_panning_ = false;
    if (!has_moved_ && event->button() == Qt::LeftButton) document_.set_probe(pixel_at(event->position()));
  } else if (is_stroking_ && event->button() == Qt::LeftButton) {
    is_stroking_ = is_key_stroke_ = false;
    tool_->release(view_.to_picture(event->position()), event->modifiers());
    update();
  }
}

void Canvas::mouseDoubleClickEvent(QMouseEvent* event) {
  if (tool_ != nullptr && event->button() == Qt::LeftButton) {
    tool_->finish();
    update();
  } else {
    mousePressEvent(event);
  }
}

void Canvas::wheelEvent(QWheelEvent* event) {
  if (image_.isNull()) return;
  const double notches = event->angleDelta().y() / 120.0;
  view_.set_zoom(view_.zoom() * std::pow(kZoomByNotch, notches), event->position());
  view_moved();
}

void Canvas::keyPressEvent(QKeyEvent* event) {
  const QPoint way = way_of(*event);
  if (!way.isNull()) return follow_arrow(way);
  switch (event->key()) {
    case Qt::Key_Plus:
    case Qt::Key_Equal: return zoom_by(kZoomByKey);
    case Qt::Key_Minus: return zoom_by(1 / kZoomByKey);
    case Qt::Key_Space:
    case Qt::Key_Backspace:
      if (tool_ == nullptr) return event->ignore();  // it plays
      if (!event->isAutoRepeat())
        press_key(event->key() == Qt::Key_Backspace ? Qt::AltModifier : Qt::NoModifier);
      return;
    case Qt::Key_Return:
    case Qt::Key_Enter:
      if (tool_ != nullptr) tool_->finish();
      if (tool_ == nullptr && is_workable()) document_.set_probe(pixel_at(key_pointer()));
      return update();
    case Qt::Key_Escape:
      if (!is_stroking_ && (tool_ != nullptr || !document_.probe())) event->ignore();
      if (tool_ != nullptr) {
        tool_->give_up();
      } else {
        document_.set_probe({});
      }
      is_stroking_ = is_key_stroke_ = false;
      return update();
    default: QWidget::keyPressEvent(event);
  }
}

// With a tool the pointer moves, else the pixel that was taken, else the picture.
void Canvas::follow_arrow(QPoint way) {
  if (!is_workable()) return;
  if (tool_ != nullptr) return move_pointer(view_.to_picture(key_pointer()) + way);
  if (!document_.probe()) {
    view_.pan(-QPointF(way) * kPanByKey);
    return view_moved();
  }
  const QRect pixels = image_.rect();
  const QPoint to = *document_.probe() + way;
  const QPoint pixel(std::clamp(to.x(), 0, pixels.right()), std::clamp(to.y(), 0, pixels.bottom()));
  document_.set_probe(pixel);
  keep_in_sight(QPointF(pixel) + QPointF(0.5, 0.5));
  Q_EMIT pointed(pixel);
}

void Canvas::press_key(Qt::KeyboardModifiers keys) {
  if (!is_workable() || (is_stroking_ && !is_key_stroke_)) return;
  if (is_key_stroke_) return end_key_stroke();
  move_pointer(view_.to_picture(key_pointer()));
  is_stroking_ = is_key_stroke_ = true;
  stroke_keys_ = keys;
  tool_->press(middle_of(view_.to_picture(pointer_)), keys);
  update();
}

void Canvas::end_key_stroke() {
  is_stroking_ = is_key_stroke_ = false;
  tool_->release(middle_of(view_.to_picture(pointer_)), stroke_keys_);
  update();
}

// Where the mouse left it; in the middle of what is seen where that is elsewhere.
QPointF Canvas::key_pointer() const {
  const QRectF seen = view_.place() & QRectF(rect());
  return seen.contains(pointer_) ? pointer_ : seen.center();
}

// To the middle of the pixel there.
void Canvas::move_pointer(QPointF picture) {
  const QPointF at = middle_of({std::clamp(picture.x(), 0.0, image_.width() - 1.0),
                                std::clamp(picture.y(), 0.0, image_.height() - 1.0)});
  is_inside_ = is_by_keys_ = true;
  keep_in_sight(at);
  pointer_ = view_.to_widget(at);
  if (is_stroking_) tool_->drag(at, stroke_keys_);
  Q_EMIT pointed(pixel_at(pointer_));
  update();
}

void Canvas::keep_in_sight(QPointF picture) {
  const QPointF at = view_.to_widget(picture);
  const QPointF within(std::clamp(at.x(), 0.0, 1.0 * width()), std::clamp(at.y(), 0.0, 1.0 * height()));
  if (at == within) return;
  view_.pan(within - at);
  view_moved();
}

void Canvas::focusInEvent(QFocusEvent* event) {
  is_framed_ = event->reason() == Qt::TabFocusReason || event->reason() == Qt::BacktabFocusReason;
  QWidget::focusInEvent(event);
}

void Canvas::focusOutEvent(QFocusEvent* event) {
  is_framed_ = false;
  if (is_key_stroke_) end_key_stroke();
  QWidget::focusOutEvent(event);
}

void Canvas::leaveEvent(QEvent*) {
  is_inside_ = false;
  update();
  Q_EMIT pointed({});
}

}  // namespace nutik::studio
