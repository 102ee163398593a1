#include "studio/curves/number_editor.hpp"

#include <QFormLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <algorithm>

#include "studio/time/times.hpp"

namespace nutik::studio {

NumberEditor::NumberEditor(QWidget* parent)
    : QFrame(parent), time_(new QLineEdit(this)), gain_(new QLineEdit(this)), mistake_(new QLabel(this)) {
  setFrameStyle(QFrame::StyledPanel | QFrame::Raised);
  setAutoFillBackground(true);
  auto* form = new QFormLayout(this);
  form->setContentsMargins(8, 8, 8, 8);
  form->setVerticalSpacing(4);
  form->addRow(tr("&Time"), time_);
  form->addRow(tr("&Gain"), gain_);
  form->addRow(mistake_);
  time_->setAccessibleName(tr("Time of the point"));
  time_->setToolTip(
      tr("A number and its unit: 0.4 s, 10 ms, 250 us, 1/100 s, or 37f for the start of sample 37"));
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

void NumberEditor::open(const ControlPoint& point, const Timeline* timeline, QPointF at) {
  point_ = point;
  timeline_ = timeline;
  time_->setText(exact_time_text(point.time_ns));
  gain_->setText(gain_text(point.gain));
  time_->setModified(false);
  gain_->setModified(false);
  mistake_->hide();
  mistake_->setFixedWidth(std::min(240, parentWidget()->width() - 20));
  adjustSize();
  constexpr int kBeside = 14;
  const QRect area = parentWidget()->rect();
  QPoint place = at.toPoint() + QPoint(kBeside, -height() / 2);
  if (place.x() + width() > area.right()) place.setX(at.toPoint().x() - kBeside - width());
  move(std::clamp(place.x(), 0, std::max(0, area.width() - width())),
       std::clamp(place.y(), 0, std::max(0, area.height() - height())));
  show();
  raise();
  time_->setFocus(Qt::PopupFocusReason);
  time_->selectAll();
}

void NumberEditor::refuse(const QString& why) {
  mistake_->setText(why);
  mistake_->show();
  adjustSize();
  const QRect area = parentWidget()->rect();
  move(std::clamp(x(), 0, std::max(0, area.width() - width())),
       std::clamp(y(), 0, std::max(0, area.height() - height())));
}

void NumberEditor::close_editor() {
  if (!isVisible()) return;
  hide();
  Q_EMIT closed();
}

void NumberEditor::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape) return close_editor();
  QFrame::keyPressEvent(event);
  event->accept();  // the curve editor must not take a letter for a command
}

void NumberEditor::enter() {
  ControlPoint typed = point_;
  if (time_->isModified()) {
    if (timeline_ == nullptr) return refuse(tr("Open a capture first"));
    const auto time = read_typed_time(time_->text(), *timeline_);
    if (!time.value) {
      time_->setFocus();
      return refuse(time.mistake);
    }
    typed.time_ns = *time.value;
  }
  if (gain_->isModified()) {
    const auto gain = read_typed_gain(gain_->text());
    if (!gain.value) {
      gain_->setFocus();
      return refuse(gain.mistake);
    }
    typed.gain = *gain.value;
  }
  Q_EMIT entered(typed);
}

}  // namespace nutik::studio
