// The time strip's mouse and keyboard.
#include <QMouseEvent>
#include <QWheelEvent>
#include <algorithm>
#include <array>
#include <cmath>

#include "session/requests/stated_moments.hpp"
#include "studio/time/time_strip.hpp"
#include "studio/time/times.hpp"

namespace nutik::studio {
namespace {

constexpr double kReach = 6;
constexpr double kFineSpeed = 0.1;

}  // namespace

bool TimeStrip::is_own_key(const QKeyEvent& event) const {
  constexpr std::array kKeys{Qt::Key_Left, Qt::Key_Right, Qt::Key_Up,    Qt::Key_Down, Qt::Key_Home,
                             Qt::Key_End,  Qt::Key_Plus,  Qt::Key_Minus, Qt::Key_I,    Qt::Key_O,
                             Qt::Key_X,    Qt::Key_Z,     Qt::Key_F};
  const bool is_letter = event.key() >= Qt::Key_A && event.key() <= Qt::Key_Z;
  const auto allowed = Qt::ShiftModifier | Qt::KeypadModifier |
                       (is_letter ? Qt::KeyboardModifiers() : Qt::KeyboardModifiers(Qt::ControlModifier));
  return (event.modifiers() & ~allowed) == 0 &&
         std::find(kKeys.begin(), kKeys.end(), event.key()) != kKeys.end();
}

TimeStrip::Part TimeStrip::part_at(QPointF at) const {
  const QRectF track = this->track();
  const auto is_mark = [&](const std::optional<std::int64_t>& mark, double direction) {
    if (!mark || at.y() >= track.top()) return false;
    const double from = (at.x() - mark_place(*mark).x()) * direction;
    return from >= -kReach / 2 && from <= kReach * 2;
  };
  if (is_mark(document_.mark_in(), 1)) return Part::mark_in;
  if (is_mark(document_.mark_out(), -1)) return Part::mark_out;
  if (at.x() < track.left() - kReach || at.x() > track.right() + kReach) return Part::none;
  const QRectF area = boxcar_area();
  // A boxcar that is too narrow for handles of its own has them outside.
  const double inside = std::clamp(area.width() / 4, 0.0, kReach);
  if (at.y() >= track.top()) {
    if (std::fabs(at.x() - area.left()) <= kReach && at.x() < area.left() + inside) return Part::begin;
    if (std::fabs(at.x() - area.right()) <= kReach && at.x() > area.right() - inside) return Part::end;
  }
  return Part::whole;
}

std::int64_t TimeStrip::held(std::int64_t time_ns, Qt::KeyboardModifiers modifiers) const {
  return modifiers & Qt::ControlModifier ? time_ns
                                         : nearest_sample_edge(time_ns, document_.facts()->timeline);
}

void TimeStrip::use(const Boxcar& boxcar, ExposureMode mode) { document_.set_boxcar(boxcar, tr("Scrub"), mode); }

void TimeStrip::mousePressEvent(QMouseEvent* event) {
  setFocus(Qt::MouseFocusReason);
  end_key_edit();
  if (press_ || document_.facts() == nullptr) return;
  const QPointF at = event->position();
  const Part part = part_at(at);
  if (event->button() == Qt::RightButton) {
    if (part == Part::mark_in) document_.set_mark_in(std::nullopt);
    if (part == Part::mark_out) document_.set_mark_out(std::nullopt);
    return;
  }
  if (event->button() == Qt::MiddleButton) {
    press_.emplace(Press{Part::pan, at, at, 0.0, document_.boxcar(), {}, {}});
    return;
  }
  if (event->button() != Qt::LeftButton || part == Part::none) return;
  press_.emplace(Press{part, at, at, 0.0, document_.boxcar(), document_.mark_in(), document_.mark_out()});
  if (part == Part::mark_in || part == Part::mark_out) return;
  document_.begin_drag();
  press_->edits = true;
  if (part == Part::whole && !boxcar_area().adjusted(0, -height(), 0, 0).contains(at)) {
    // It comes to the pointer.
    Boxcar boxcar = document_.boxcar();
    boxcar.start_ns = held(axis_.to_time(at.x(), width()) - boxcar.length_ns / 2, event->modifiers());
    use(boxcar, document_.mode());  // regions are left for it once it is dragged
    press_->from = document_.boxcar();
  }
}

void TimeStrip::drag_to(QPointF at, Qt::KeyboardModifiers modifiers) {
  const double speed = modifiers & Qt::ShiftModifier ? kFineSpeed : 1.0;
  press_->hand_ns += (at.x() - press_->last.x()) * axis_.ns_per_pixel(width()) * speed;
  press_->last = at;
  const std::int64_t by_ns = std::llround(press_->hand_ns);
  const Boxcar& from = press_->from;
  const std::int64_t end_ns = from.start_ns + from.length_ns;
  switch (press_->part) {
    case Part::whole: return use({held(from.start_ns + by_ns, modifiers), from.length_ns});
    case Part::begin: {
      const std::int64_t begin =
          std::clamp<std::int64_t>(held(from.start_ns + by_ns, modifiers), 0, end_ns - 1);
      return use({begin, end_ns - begin});
    }
    case Part::end: {
      const std::int64_t end = std::clamp<std::int64_t>(held(end_ns + by_ns, modifiers), from.start_ns + 1,
                                                        document_.duration_ns());
      return use({from.start_ns, end - from.start_ns});
    }
    case Part::mark_in:
      if (press_->mark_in) document_.set_mark_in(held(*press_->mark_in + by_ns, modifiers));
      return;
    case Part::mark_out:
      if (press_->mark_out) document_.set_mark_out(held(*press_->mark_out + by_ns, modifiers));
      return;
    case Part::pan:
    case Part::none: return;
  }
}

void TimeStrip::mouseMoveEvent(QMouseEvent* event) {
  const QPointF at = event->position();
  if (!press_) {
    const Part part = document_.facts() == nullptr ? Part::none : part_at(at);
    const bool is_edge = part == Part::begin || part == Part::end;
    return setCursor(is_edge              ? Qt::SplitHCursor
                     : part == Part::none ? Qt::ArrowCursor
                                          : Qt::PointingHandCursor);
  }
  if (press_->part == Part::pan) {
    axis_.pan(press_->last.x() - at.x(), width());
    press_->last = at;
  } else if (at.x() != press_->last.x() && (document_.mode() == ExposureMode::boxcar || !press_->edits ||
                                            QLineF(press_->at, at).length() >= kReach / 2)) {  // a click that shakes
    drag_to(at, event->modifiers());
  }
}

void TimeStrip::mouseReleaseEvent(QMouseEvent* event) {
  if (!press_ || (event->button() != Qt::LeftButton && event->button() != Qt::MiddleButton)) return;
  if ((event->button() == Qt::MiddleButton) != (press_->part == Part::pan)) return;
  const bool edits = press_->edits;
  press_.reset();
  if (edits) document_.end_drag();
}

void TimeStrip::cancel_press() {
  if (!press_) return;
  const Press press = std::move(*press_);
  press_.reset();
  if (press.edits) document_.give_up_drag(tr("Scrub"));
  if (press.part == Part::mark_in || press.part == Part::mark_out) {
    document_.set_mark_in(press.mark_in);
    document_.set_mark_out(press.mark_out);
  }
}

void TimeStrip::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape && press_) return cancel_press();
  if (press_ || document_.facts() == nullptr) return event->ignore();
  if (!look_by_key(*event) && !move_by_key(*event)) QWidget::keyPressEvent(event);
}

bool TimeStrip::move_by_key(const QKeyEvent& event) {
  const Timeline& timeline = document_.facts()->timeline;
  const bool is_ten = event.modifiers() & Qt::ShiftModifier,
             is_fine = event.modifiers() & Qt::ControlModifier;
  const std::int64_t steps = is_ten ? 10 : 1;
  Boxcar boxcar = document_.boxcar();
  const auto later = [&](std::int64_t time_ns, std::int64_t by) {
    return is_fine ? time_ns + by : samples_later(time_ns, by, timeline);
  };
  const std::int64_t end_ns = boxcar.start_ns + boxcar.length_ns;
  switch (event.key()) {
    case Qt::Key_Left: boxcar.start_ns = later(boxcar.start_ns, -steps); break;
    case Qt::Key_Right: boxcar.start_ns = later(boxcar.start_ns, steps); break;
    case Qt::Key_Up: boxcar.length_ns = later(end_ns, steps) - boxcar.start_ns; break;
    case Qt::Key_Down: boxcar.length_ns = later(end_ns, -steps) - boxcar.start_ns; break;
    case Qt::Key_Home: boxcar.start_ns = 0; break;
    case Qt::Key_End: boxcar.start_ns = document_.duration_ns() - boxcar.length_ns; break;
    default: return false;
  }
  // Longer does not push the start, shorter leaves something.
  boxcar.length_ns = std::min(boxcar.length_ns,
                              std::max(document_.duration_ns() - boxcar.start_ns, end_ns - boxcar.start_ns));
  if (boxcar.length_ns < 1) return true;
  begin_key_edit(event);
  use(boxcar);
  return true;
}

bool TimeStrip::look_by_key(const QKeyEvent& event) {
  constexpr double kZoom = 0.8;
  const Boxcar& boxcar = document_.boxcar();
  const std::int64_t end_ns = boxcar.start_ns + boxcar.length_ns;
  const bool clears = event.modifiers() & Qt::ShiftModifier;
  const auto none = std::optional<std::int64_t>();
  if (event.modifiers() & Qt::ControlModifier) return false;
  switch (event.key()) {
    case Qt::Key_I: document_.set_mark_in(clears ? none : std::optional(boxcar.start_ns)); return true;
    case Qt::Key_O: document_.set_mark_out(clears ? none : std::optional(end_ns)); return true;
    case Qt::Key_X:
      if (document_.mark_in() && document_.mark_out())
        document_.set_boxcar({*document_.mark_in(), *document_.mark_out() - *document_.mark_in()},
                             tr("Expose from mark to mark"));
      return true;
    case Qt::Key_Z: {
      const double begin = static_cast<double>(document_.mark_in().value_or(boxcar.start_ns));
      const double end = static_cast<double>(document_.mark_out().value_or(end_ns));
      if (end > begin) axis_.show(begin - 0.1 * (end - begin), end + 0.1 * (end - begin));
      return true;
    }
    case Qt::Key_F: axis_.show_all(); return true;
    case Qt::Key_Plus: axis_.zoom(kZoom, boxcar_area().center().x(), width()); return true;
    case Qt::Key_Minus: axis_.zoom(1 / kZoom, boxcar_area().center().x(), width()); return true;
    default: return false;
  }
}

QString TimeStrip::text_at(QPointF at) const {
  if (document_.facts() == nullptr) return {};
  const Timeline& timeline = document_.facts()->timeline;
  switch (part_at(at)) {
    case Part::mark_in:
      return tr("In: %1\nDrag to move it, right click to take it away").arg(exact_time_text(*document_.mark_in()));
    case Part::mark_out:
      return tr("Out: %1\nDrag to move it, right click to take it away").arg(exact_time_text(*document_.mark_out()));
    case Part::begin: return tr("Drag to move the interval's begin");
    case Part::end: return tr("Drag to move the interval's end");
    case Part::whole: {
      if (boxcar_area().contains(at)) return tr("Exposed: %1").arg(interval_text(document_.boxcar(), timeline));
      const std::int64_t time_ns = axis_.to_time(at.x(), width());
      if (time_ns < 0 || time_ns >= timeline.duration_ns()) return tr("Outside the capture");
      const std::uint64_t sample = sample_at(time_ns, timeline);
      const auto picture = timeline.picture_of(sample);
      QString text =
          picture ? tr("Picture %1, from %2").arg(*picture).arg(exact_time_text(timeline.pictures().start_ns(*picture)))
                  : tr("Made sample, from %1").arg(exact_time_text(timeline.start_ns(sample)));
      if (!activity_.empty())
        text += tr("\n%1 % of the pixels change").arg(100 * activity_.values()[sample], 0, 'g', 3);
      return text + tr("\nClick to bring the interval here");
    }
    case Part::pan:
    case Part::none: return {};
  }
  return {};
}

}  // namespace nutik::studio
