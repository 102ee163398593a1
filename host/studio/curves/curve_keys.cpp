// The curve editor's keyboard, and what it says to those who point or listen.
#include <QKeyEvent>
#include <algorithm>
#include <array>
#include <cmath>

#include "session/requests/stated_moments.hpp"
#include "studio/curves/curve_editor.hpp"
#include "studio/curves/number_editor.hpp"
#include "studio/time/times.hpp"

namespace nutik::studio {
namespace {

// Without the last digits that sums of decimal fractions leave.
double tidy(double gain) {
  constexpr int kDigits = 12;
  return QString::number(gain, 'g', kDigits).toDouble();
}

}  // namespace

bool CurveEditor::is_own_key(const QKeyEvent& event) const {
  constexpr std::array kKeys{Qt::Key_Left,   Qt::Key_Right,  Qt::Key_Up,    Qt::Key_Down, Qt::Key_Home,
                             Qt::Key_End,    Qt::Key_Delete, Qt::Key_Enter, Qt::Key_Plus, Qt::Key_Backspace,
                             Qt::Key_Insert, Qt::Key_Return, Qt::Key_Minus, Qt::Key_F};
  if (event.key() == Qt::Key_A) return event.modifiers() == Qt::ControlModifier;
  const auto allowed = Qt::ShiftModifier | Qt::ControlModifier | Qt::KeypadModifier;
  return (event.modifiers() & ~allowed) == 0 &&
         std::find(kKeys.begin(), kKeys.end(), event.key()) != kKeys.end();
}

void CurveEditor::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape) {
    if (!press_ && document_.selected_points().empty()) return event->ignore();
    if (press_) return cancel_press();
    return select({}, std::nullopt);
  }
  if (press_ || document_.facts() == nullptr) return event->ignore();
  if (!look_by_key(*event) && !edit_by_key(*event)) QWidget::keyPressEvent(event);
}

// What changes nothing but what is seen and selected.
bool CurveEditor::look_by_key(const QKeyEvent& event) {
  constexpr double kZoom = 0.8;
  const double middle = current_ ? frame().x_of(points_[*current_].time_ns) : plot_area().center().x();
  switch (event.key()) {
    case Qt::Key_Home:
      if (!points_.empty()) step_to(0);
      return true;
    case Qt::Key_End:
      if (!points_.empty()) step_to(points_.size() - 1);
      return true;
    case Qt::Key_Plus: axis_.zoom(kZoom, middle, width()); return true;
    case Qt::Key_Minus: axis_.zoom(1 / kZoom, middle, width()); return true;
    case Qt::Key_F:
      axis_.show_all();
      gains_.make_automatic(points_);
      refresh_backdrop();
      return true;
    case Qt::Key_A: {
      if (event.modifiers() != Qt::ControlModifier) return false;
      PointIndices all(points_.size());
      for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
      select(all, current_);
      return true;
    }
    default: return false;
  }
}

bool CurveEditor::edit_by_key(const QKeyEvent& event) {
  const bool is_ten = event.modifiers() & Qt::ShiftModifier,
             is_fine = event.modifiers() & Qt::ControlModifier;
  const std::int64_t samples = is_fine ? 0 : is_ten ? 10 : 1, ns = is_fine ? (is_ten ? 10 : 1) : 0;
  const double gain = (is_fine ? 0.01 : 0.1) * (is_ten ? 10 : 1);
  const bool is_arrow = event.key() == Qt::Key_Left || event.key() == Qt::Key_Right ||
                        event.key() == Qt::Key_Up || event.key() == Qt::Key_Down;
  if (is_arrow && !selected().empty()) begin_key_edit(event);
  switch (event.key()) {
    case Qt::Key_Left: nudge(-samples, -ns); return true;
    case Qt::Key_Right: nudge(samples, ns); return true;
    case Qt::Key_Up: raise(gain); return true;
    case Qt::Key_Down: raise(-gain); return true;
    case Qt::Key_Delete:
    case Qt::Key_Backspace: remove_selected(); return true;
    case Qt::Key_Insert: insert_point(); return true;
    case Qt::Key_Return:
    case Qt::Key_Enter: type_numbers(); return true;
    default: return false;
  }
}

void CurveEditor::focusInEvent(QFocusEvent* event) {
  // Tab leads to the first point, Shift+Tab to the last.
  if (!current_ && !points_.empty() && event->reason() == Qt::TabFocusReason) step_to(0);
  if (!current_ && !points_.empty() && event->reason() == Qt::BacktabFocusReason) step_to(points_.size() - 1);
  QWidget::focusInEvent(event);
  update();
}

bool CurveEditor::focusNextPrevChild(bool next) {
  const bool is_at_end = !current_ || (next ? *current_ + 1 >= points_.size() : *current_ == 0);
  if (numbers_->isVisible() || is_at_end) return QWidget::focusNextPrevChild(next);
  step_to(next ? *current_ + 1 : *current_ - 1);
  return true;
}

void CurveEditor::step_to(std::size_t point) {
  const double x = frame().x_of(points_[point].time_ns);
  const QRectF area = plot_area();
  if (x < area.left() || x > area.right()) axis_.pan(x - area.center().x(), width());
  select({point}, point);
}

void CurveEditor::nudge(std::int64_t samples, std::int64_t ns) {
  const PointIndices chosen = selected();
  if (chosen.empty()) return;
  const std::int64_t from = points_[step_anchor(points_, current_.value_or(chosen.front()))].time_ns;
  const std::int64_t by =
      samples == 0 ? ns : samples_later(from, samples, document_.facts()->timeline) - from;
  use(moved(points_, chosen, {by, 0.0}), tr("Move point"));
}

void CurveEditor::raise(double by) {
  const PointIndices chosen = selected();
  if (chosen.empty()) return;
  Points points = moved(points_, chosen, {0, by});
  for (const std::size_t i : chosen) points[i].gain = tidy(points[i].gain);
  use(points, tr("Change gain"));
}

void CurveEditor::remove_selected() {
  const PointIndices chosen = selected();
  if (chosen.empty()) return;
  const auto left = without(points_, chosen);
  if (!left) {
    message_ = tr("A function keeps one point at least");
    return update();
  }
  const std::size_t next = std::min(chosen.front(), left->size() - 1);
  select({}, std::nullopt);
  use(*left, chosen.size() == 1 ? tr("Remove point") : tr("Remove %1 points").arg(chosen.size()));
  select({next}, next);
}

// In the middle between the keyboard's point and the next one; where there is none, in the middle of what is seen.
void CurveEditor::insert_point() {
  std::int64_t time_ns = std::llround((axis_.begin_ns() + axis_.end_ns()) / 2);
  if (points_.empty()) {
    use({{std::max<std::int64_t>(time_ns, 0), 1.0}}, tr("Add point"));
    return select({0}, std::size_t{0});
  }
  if (current_ && *current_ + 1 < points_.size()) {
    const std::int64_t from = points_[*current_].time_ns;
    time_ns = from + (points_[*current_ + 1].time_ns - from) / 2;
  }
  const auto added = with_point(points_, {time_ns, gain_at(points_, time_ns)});
  if (!added) {
    message_ = tr("There is no room for a point between these two");
    return update();
  }
  use(added->points, tr("Add point"));
  select({added->index}, added->index);
}

void CurveEditor::type_numbers() {
  if (!current_ || *current_ >= points_.size()) return;
  numbers_->open(points_[*current_], document_.facts()->timeline, frame().place(points_[*current_]));
}

QString CurveEditor::text_at(QPointF at) const {
  const PlotFrame frame = this->frame();
  QString said;
  const auto say = [&said](const QString& text) { said += (said.isEmpty() ? "" : "\n") + text; };
  if (at.y() < plot_area().top()) {
    for (const FunctionFinding& finding : findings_) say(QString::fromStdString(finding.message));
    return said;
  }
  if (at.x() < TimeAxis::kLeft - kReachPixels)
    return tr("Gain: what the light of a moment is multiplied by. Ctrl and wheel zoom, a double click shows all "
              "gains");
  if (const auto point = point_under(frame, points_, selected(), at)) {
    say(tr("Point %1 of M%2: %3")
            .arg(*point + 1)
            .arg(document_.selected_tag())
            .arg(point_text(points_[*point])));
    for (const FunctionFinding& finding : findings_)
      if (finding.point == *point) say(QString::fromStdString(finding.message));
    say(tr("Drag to move it, double click to type, right click to take it away"));
    return said;
  }
  if (const auto hit = boxcar_under(frame, boxcars_, lane_top(), at)) {
    switch (hit->part) {
      case BoxcarPart::whole: return tr("Drag to move this boxcar");
      case BoxcarPart::begin: return tr("Drag to move the boxcar's begin");
      case BoxcarPart::end: return tr("Drag to move the boxcar's end");
      case BoxcarPart::gain: return tr("Drag to change the boxcar's gain");
    }
  }
  const auto box = this->box();
  const auto part = box ? box->part_under(at) : std::nullopt;
  if (part == BoxPart::left || part == BoxPart::right) return tr("Drag to stretch the selected points in time");
  if (part == BoxPart::top || part == BoxPart::bottom) return tr("Drag to multiply the selected points' gains");
  if (is_on_curve(frame, points_, at)) return tr("Click for a new point");
  if (part == BoxPart::inside) return tr("Drag to move the selected points");
  if (part) return tr("Drag to stretch the selected points in time and to multiply their gains");
  return said;
}

}  // namespace nutik::studio
