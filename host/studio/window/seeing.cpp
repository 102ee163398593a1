// How the window looks at a picture: its light, another one beside it, keys that are held.
#include <QAction>
#include <QKeyEvent>
#include <QLineEdit>
#include <algorithm>

#include "studio/regions/region_list.hpp"
#include "studio/window/main_window.hpp"

namespace nutik::studio {

void MainWindow::measure_light() {
  measuring_.cancel();
  if (!session_ || !(histogram_->isVisible() || clipping_->isChecked())) return;
  measuring_.start(
      tr("Measuring the light"),
      [session = session_, state = document_.state()](const Job& job) { return measured_light(*session, state, job); },
      [this](MeasuredLight light) {
        light_ = std::make_shared<const MeasuredLight>(std::move(light));
        histogram_->show_light(light_);
        regions_->count_clipped(*light_);
        mark_clipped();
      });
}

// It is another picture's.
void MainWindow::forget_light() {
  measuring_.cancel();
  light_.reset();
  Glance glance = canvas_->glance();
  if (glance.marks.isNull() && glance.held.isNull() && glance.instead.isNull())
    return;  // nothing of the picture is painted anew
  if (!glance.instead.isNull()) notice_->clear();  // which offers to save it
  glance.marks = glance.held = glance.instead = {};
  canvas_->look(std::move(glance));
}

void MainWindow::mark_clipped() {
  Glance glance = canvas_->glance();
  if (glance.marks.isNull() && !clipping_->isChecked()) return;
  glance.marks = light_ && clipping_->isChecked() ? light_->marks : QImage();
  canvas_->look(std::move(glance));
}

bool MainWindow::keep_snapshot() {
  if (document_.played()) {
    notice_->say(Notice::Kind::note, tr("Stop the film first: snapshot A is of the picture."));
    return false;
  }
  snapshot_ = {document_.state(), canvas_->image()};
  return true;
}

void MainWindow::swap_snapshot() {
  if (!snapshot_) return;
  const Snapshot before = *snapshot_;
  if (!keep_snapshot()) return;
  document_.apply(before.state, tr("Swap with snapshot A"));
}

// Whether the key has a meaning while it is held.
bool MainWindow::hold(int key, bool is_held) {
  Glance glance = canvas_->glance();
  switch (key) {
    case Qt::Key_H: glance.without_outlines = is_held; break;
    case Qt::Key_M: glance.is_magnified = is_held; break;
    case Qt::Key_A: glance.held = is_held && snapshot_ ? snapshot_->image : QImage(); break;
    default: return false;
  }
  canvas_->look(std::move(glance));
  return true;
}

// A key that is released in another window is released all the same.
void MainWindow::let_go() {
  for (const int key : {Qt::Key_H, Qt::Key_M, Qt::Key_A}) hold(key, false);
}

// Fields would take the window's keys for their own: Ctrl+E, and Ctrl+Z where they have nothing to undo. Whoever turns
// the wheel over them may mean the panel.
bool MainWindow::eventFilter(QObject* field, QEvent* event) {
  if (event->type() == QEvent::Wheel && !static_cast<QWidget*>(field)->hasFocus()) {
    event->ignore();
    return true;
  }
  auto* line = qobject_cast<QLineEdit*>(field);
  if (line == nullptr) line = field->findChild<QLineEdit*>();
  if (event->type() != QEvent::ShortcutOverride || line == nullptr) return false;
  const auto& key = static_cast<const QKeyEvent&>(*event);
  const bool is_fields = !key.modifiers().testFlag(Qt::ControlModifier) ||
                         (key.matches(QKeySequence::Undo) && line->isUndoAvailable()) ||
                         (key.matches(QKeySequence::Redo) && line->isRedoAvailable());
  const auto is_asked = [&](const QAction* action) { return action->shortcuts().contains(key.keyCombination()); };
  if (is_fields || std::ranges::none_of(findChildren<QAction*>(), is_asked)) return false;
  event->ignore();
  return true;
}

void MainWindow::keyPressEvent(QKeyEvent* event) {
  const bool is_plain = event->modifiers() == Qt::NoModifier;
  if (is_plain && (event->isAutoRepeat() || hold(event->key(), true))) return;
  if (event->key() == Qt::Key_Space) return play_or_stop();
  if (event->key() != Qt::Key_Escape) return QMainWindow::keyPressEvent(event);
  if (playing_.isActive()) return stop_playing();
  if (Glance glance = canvas_->glance(); !glance.instead.isNull()) {
    glance.instead = {};
    notice_->clear();  // which offers to save it
    return canvas_->look(std::move(glance));
  }
  // Nothing in the window had a use for it.
  (notice_->isVisible() ? notice_ : offer_)->clear();
}

void MainWindow::keyReleaseEvent(QKeyEvent* event) {
  if (event->isAutoRepeat() || !hold(event->key(), false)) QMainWindow::keyReleaseEvent(event);
}

}  // namespace nutik::studio
