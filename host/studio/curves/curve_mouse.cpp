// The curve editor's mouse.
#include <QLineF>
#include <QMouseEvent>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

#include "studio/curves/curve_editor.hpp"

namespace nutik::studio {
namespace {

constexpr double kStillPixels = 2;  // a hand that clicks moves less
constexpr double kFine = 0.1;       // as fast as the hand, with Shift

double power_of_ten_below(double value) { return std::pow(10.0, std::floor(std::log10(value))); }

Qt::CursorShape shape_of(BoxPart part) {
  switch (part) {
    case BoxPart::left:
    case BoxPart::right: return Qt::SizeHorCursor;
    case BoxPart::top:
    case BoxPart::bottom: return Qt::SizeVerCursor;
    case BoxPart::top_left:
    case BoxPart::bottom_right: return Qt::SizeFDiagCursor;
    case BoxPart::top_right:
    case BoxPart::bottom_left: return Qt::SizeBDiagCursor;
    case BoxPart::inside: return Qt::SizeAllCursor;
  }
  return Qt::ArrowCursor;
}

Qt::CursorShape shape_of(BoxcarPart part) {
  switch (part) {
    case BoxcarPart::whole: return Qt::OpenHandCursor;
    case BoxcarPart::begin:
    case BoxcarPart::end: return Qt::SplitHCursor;
    case BoxcarPart::gain: return Qt::SizeVerCursor;
  }
  return Qt::ArrowCursor;
}

}  // namespace

void CurveEditor::mousePressEvent(QMouseEvent* event) {
  setFocus(Qt::MouseFocusReason);
  end_key_edit();
  if (press_ || document_.facts() == nullptr) return;
  const QPointF at = event->position();
  if (event->button() == Qt::RightButton) return remove_at(at);
  if (event->button() == Qt::MiddleButton) {
    press_.emplace(Press{Press::Kind::pan, at, at, {}, {}});
    setCursor(Qt::ClosedHandCursor);
    return;
  }
  if (event->button() != Qt::LeftButton || at.x() < TimeAxis::kLeft - kReachPixels) return;

  const PlotFrame frame = this->frame();
  if (const auto point = point_under(frame, points_, selected(), at)) return press_point(*point, *event);
  const auto box = this->box();
  const auto part = box ? box->part_under(at) : std::nullopt;
  const auto hit = boxcar_under(frame, boxcars_, lane_top(), at);
  const bool is_inside = part == BoxPart::inside;
  if (part && !(is_inside && hit)) {
    start(drag_box(points_, selected(), *box, *part, snapper(selected())), at);
    press_->adds_point = is_inside && is_on_curve(frame, points_, at);
    return;
  }
  if (hit) {
    const PointIndices own{hit->boxcar.first, hit->boxcar.last};
    select({}, std::nullopt);
    return start(drag_boxcar(points_, *hit, snapper(own)), at);
  }
  if (is_on_curve(frame, points_, at)) return press_curve(at);
  const bool adds = event->modifiers() & (Qt::ShiftModifier | Qt::ControlModifier);
  press_.emplace(Press{Press::Kind::rubber_band, at, at, {}, {}});
  if (adds) press_->kept = selected();
}

void CurveEditor::press_point(std::size_t point, const QMouseEvent& event) {
  PointIndices chosen = selected();
  const auto at = std::lower_bound(chosen.begin(), chosen.end(), point);
  const bool is_selected = at != chosen.end() && *at == point;
  const bool adds = event.modifiers() & (Qt::ShiftModifier | Qt::ControlModifier);
  if (!is_selected && adds) chosen.insert(at, point);
  if (!is_selected && !adds) chosen = {point};
  select(chosen, point);
  start(drag_points(points_, chosen, point, snapper(chosen)), event.position());
  if (is_selected && adds) press_->toggles = point;
}

void CurveEditor::press_curve(QPointF at) {
  const PlotFrame frame = this->frame();
  const double ns_per_pixel = frame.ns_per_pixel();
  std::int64_t time_ns = frame.time_at(at.x());
  const auto snap = snapper({}).time(time_ns, kReachPixels * ns_per_pixel);
  std::optional<AddedPoint> added;
  if (snap) added = with_point(points_, {snap->time_ns, gain_at(points_, snap->time_ns)});
  if (!added) added = with_point(points_, {time_ns, gain_at(points_, time_ns)});
  if (!added) {
    message_ = tr("There is a point at this time already");
    return update();
  }
  Press press{Press::Kind::drag, at, at, {}, {}};
  press.tag = document_.selected_tag();
  press.has_moved = true;
  press_ = std::move(press);
  document_.begin_drag();
  use(added->points, tr("Add point"));
  select({added->index}, added->index);
  press_->drag = drag_points(points_, {added->index}, added->index, snapper({added->index}));
}

void CurveEditor::start(Drag drag, QPointF at) {
  press_.emplace(Press{Press::Kind::drag, at, at, {}, std::move(drag)});
  press_->tag = document_.selected_tag();
}

void CurveEditor::drag_to(QPointF at, Qt::KeyboardModifiers modifiers) {
  const PlotFrame frame = this->frame();
  const bool is_fine = modifiers & Qt::ShiftModifier, is_free = modifiers & Qt::ControlModifier;
  const double ns_per_pixel = frame.ns_per_pixel(), gain_per_pixel = frame.gain_per_pixel();
  const double speed = is_fine ? kFine : 1.0;
  press_->hand += QPointF((at.x() - press_->last.x()) * ns_per_pixel * speed,
                          (press_->last.y() - at.y()) * gain_per_pixel * speed);
  press_->last = at;
  if (!press_->has_moved) {
    if (QLineF(press_->at, at).length() < kStillPixels) return;
    press_->has_moved = true;
    document_.begin_drag();
  }
  const double reach = is_free ? 0.0 : kReachPixels * speed;
  HandShift shift;
  shift.time_ns = press_->hand.x();
  shift.gain = press_->hand.y();
  shift.time_step_ns = std::max(1.0, power_of_ten_below(ns_per_pixel * speed));
  shift.gain_step = power_of_ten_below(gain_per_pixel * speed);
  shift.time_reach_ns = reach * ns_per_pixel;
  shift.gain_reach = reach * gain_per_pixel;
  shift.alone = is_free;
  dragged_ = press_->drag->by(shift);
  if (is_free) dragged_->time_snap.reset(), dragged_->gain_snap.reset();
  if (dragged_->points == points_) return update();
  use(dragged_->points, press_->drag->name);
}

void CurveEditor::mouseMoveEvent(QMouseEvent* event) {
  const QPointF at = event->position();
  if (!press_) {
    hovered_ = at;
    set_shape_at(at);
    return update();
  }
  switch (press_->kind) {
    case Press::Kind::drag: return drag_to(at, event->modifiers());
    case Press::Kind::pan:
      axis_.pan(press_->last.x() - at.x(), width());
      press_->last = at;
      return;
    case Press::Kind::rubber_band: {
      press_->last = at;
      press_->has_moved = press_->has_moved || QLineF(press_->at, at).length() >= kStillPixels;
      if (!press_->has_moved) return;
      PointIndices chosen = points_within(frame(), points_, QRectF(press_->at, at).normalized());
      chosen.insert(chosen.end(), press_->kept.begin(), press_->kept.end());
      std::sort(chosen.begin(), chosen.end());
      chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
      select(chosen, chosen.empty() ? std::nullopt : std::optional(chosen.front()));
      return;
    }
  }
}

void CurveEditor::mouseReleaseEvent(QMouseEvent* event) {
  if (!press_ || (event->button() == Qt::MiddleButton) != (press_->kind == Press::Kind::pan)) return;
  if (event->button() != Qt::LeftButton && event->button() != Qt::MiddleButton) return;
  const Press press = std::move(*press_);
  press_.reset();
  dragged_.reset();
  if (press.kind == Press::Kind::drag && press.has_moved) {
    document_.end_drag();
  } else if (press.kind == Press::Kind::drag && press.adds_point) {
    press_curve(press.at);
    if (press_) document_.end_drag();
    press_.reset();
  } else if (press.toggles) {
    PointIndices chosen = selected();
    chosen.erase(std::remove(chosen.begin(), chosen.end(), *press.toggles), chosen.end());
    select(chosen, chosen.empty() ? std::nullopt : std::optional(chosen.back()));
  } else if (press.kind == Press::Kind::rubber_band && !press.has_moved) {
    select(press.kept, press.kept.empty() ? std::nullopt : current_);
  }
  hovered_ = event->position();
  set_shape_at(event->position());
  update();
}

void CurveEditor::mouseDoubleClickEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return;
  const QPointF at = event->position();
  if (at.x() < TimeAxis::kLeft - kReachPixels) {
    gains_.make_automatic(points_);
    return refresh_backdrop();
  }
  const auto point = point_under(frame(), points_, selected(), at);
  if (!point) return mousePressEvent(event);
  select({*point}, point);
  type_numbers();
}

// The function went away while it was dragged, by undo or a shortcut: what is left of the drag is nobody's.
void CurveEditor::drop_press() {
  press_.reset();
  dragged_.reset();
  document_.end_drag();
}

void CurveEditor::cancel_press() {
  if (!press_) return;
  const Press press = std::move(*press_);
  press_.reset();
  dragged_.reset();
  if (press.kind == Press::Kind::drag && press.has_moved) document_.give_up_drag(tr("Move point"));
  update();
}

void CurveEditor::remove_at(QPointF at) {
  const auto point = point_under(frame(), points_, selected(), at);
  if (!point) return;
  const auto left = without(points_, {*point});
  if (!left) {
    message_ = tr("A function keeps one point at least");
    return update();
  }
  PointIndices chosen;
  for (const std::size_t i : selected())
    if (i != *point) chosen.push_back(i < *point ? i : i - 1);
  select({}, std::nullopt);
  use(*left, tr("Remove point"));
  select(chosen, std::nullopt);
}

void CurveEditor::set_shape_at(QPointF at) {
  const PlotFrame frame = this->frame();
  if (point_under(frame, points_, selected(), at)) return setCursor(Qt::PointingHandCursor);
  const auto hit = boxcar_under(frame, boxcars_, lane_top(), at);
  if (const auto box = this->box()) {
    const auto part = box->part_under(at);
    if (part.has_value() && !(hit && part.value() == BoxPart::inside))
      return setCursor(shape_of(part.value()));
  }
  if (hit) return setCursor(shape_of(hit->part));
  setCursor(is_on_curve(frame, points_, at) ? Qt::CrossCursor : Qt::ArrowCursor);
}

void CurveEditor::leaveEvent(QEvent*) {
  hovered_.reset();
  update();
}

void CurveEditor::wheelEvent(QWheelEvent* event) {
  const double turned = notches_of(*event);
  if (turned == 0 || !(event->modifiers() & Qt::ControlModifier)) return TimeView::wheelEvent(event);
  if (!press_) gains_.zoom(std::pow(kPerNotch, turned), frame().gain_at(event->position().y()));
  refresh_backdrop();
  event->accept();
}

}  // namespace nutik::studio
