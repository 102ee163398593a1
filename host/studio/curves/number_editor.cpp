#include "studio/curves/number_editor.hpp"

#include <QFormLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <algorithm>

#include "studio/time/times.hpp"

namespace nutik::studio {

NumberEditor::NumberEditor(QWidget* parent, Use use)
    : QFrame(parent),
      use_(std::move(use)),
      time_(new QLineEdit(this)),
      gain_(new QLineEdit(this)),
      mistake_(new QLabel(this)) {
  setFrameStyle(QFrame::StyledPanel | QFrame::Raised);
  setAutoFillBackground(true);
  auto* form = new QFormLayout(this);
  form->setContentsMargins(8, 8, 8, 8);
  form->setVerticalSpacing(4);
  form->addRow(tr("&Time"), time_);
  form->addRow(tr("&Gain"), gain_);
  form->addRow(mistake_);
  time_->setAccessibleName(tr("Time of the point"));
  time_->setToolTip(typed_time_help());
  gain_->setAccessibleName(tr("Gain of the point"));
  gain_->setToolTip(tr("Any number, also below 0: what the light of this moment is multiplied by"));
  mistake_->setWordWrap(true);
  for (QLineEdit* line : {time_, gain_}) {
    line->setMinimumWidth(170);
    connect(line, &QLineEdit::returnPressed, this, &NumberEditor::enter);
    connect(line, &QLineEdit::textEdited, this, [this] {
      mistake_->hide();
      adjustSize();
    });
  }
  hide();
}

void NumberEditor::open(const ControlPoint& point, const Timeline& timeline, QPointF at) {
  point_ = point;
  timeline_ = &timeline;
  time_->setText(exact_time_text(point.time_ns));
  gain_->setText(gain_text(point.gain));
  time_->setModified(false);
  gain_->setModified(false);
  mistake_->hide();
  mistake_->setFixedWidth(std::min(240, parentWidget()->width() - 20));
  adjustSize();
  constexpr int kBeside = 14;
  QPoint place = at.toPoint() + QPoint(kBeside, -height() / 2);
  if (place.x() + width() > parentWidget()->rect().right()) place.setX(at.toPoint().x() - kBeside - width());
  move_within_parent(place);
  show();
  raise();
  time_->setFocus(Qt::PopupFocusReason);
  time_->selectAll();
}

void NumberEditor::refuse(const QString& why) {
  mistake_->setText(why);
  mistake_->show();
  adjustSize();
  move_within_parent(pos());
}

void NumberEditor::move_within_parent(QPoint place) {
  const QSize room = parentWidget()->size() - size();
  move(std::clamp(place.x(), 0, std::max(0, room.width())), std::clamp(place.y(), 0, std::max(0, room.height())));
}

void NumberEditor::close_editor() {
  if (!isVisible()) return;
  hide();
  parentWidget()->setFocus(Qt::OtherFocusReason);
}

void NumberEditor::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape) return close_editor();
  QFrame::keyPressEvent(event);
  event->accept();  // the curve editor must not take a letter for a command
}

void NumberEditor::enter() {
  ControlPoint typed = point_;
  // False: it cannot be read, which was said.
  const auto take = [this](QLineEdit& field, auto& number, const auto& read) {
    if (!field.isModified()) return true;
    const auto found = read(field.text());
    if (found.value) {
      number = *found.value;
      return true;
    }
    field.setFocus();
    refuse(found.mistake);
    return false;
  };
  const auto read_time = [this](const QString& text) { return read_typed_time(text, *timeline_); };
  if (!take(*time_, typed.time_ns, read_time) || !take(*gain_, typed.gain, read_typed_gain)) return;
  const QString mistake = use_(typed);
  mistake.isEmpty() ? close_editor() : refuse(mistake);
}

}  // namespace nutik::studio
