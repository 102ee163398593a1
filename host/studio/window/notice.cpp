#include "studio/window/notice.hpp"

#include <QHBoxLayout>
#include <QLabel>
#include <QToolButton>

namespace nutik::studio {

Notice::Notice(QWidget* parent) : QFrame(parent), text_(new QLabel(this)) {
  setAutoFillBackground(true);
  setFrameShape(QFrame::NoFrame);
  text_->setWordWrap(true);
  text_->setTextFormat(Qt::PlainText);
  text_->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  text_->setAccessibleName(tr("Message"));
  auto* close = new QToolButton(this);
  close->setText(tr("Close"));
  close->setAutoRaise(true);
  close->setAccessibleName(tr("Close the message"));
  connect(close, &QToolButton::clicked, this, &Notice::clear);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(12, 6, 6, 6);
  row->addWidget(text_, 1);
  row->addWidget(close, 0, Qt::AlignTop);
  hide();
}

void Notice::say(Kind kind, const QString& text) {
  const QColor ground = kind == Kind::error ? QColor(122, 46, 40) : QColor(52, 76, 104);
  QPalette colours = palette();
  for (const auto role : {QPalette::Window, QPalette::Button}) colours.setColor(role, ground);
  for (const auto role : {QPalette::WindowText, QPalette::ButtonText, QPalette::Text})
    colours.setColor(role, QColor(240, 240, 240));
  setPalette(colours);
  text_->setText(text);
  setVisible(!text.isEmpty());
}

void Notice::clear() { say(Kind::note, {}); }

QString Notice::text() const { return text_->text(); }

}  // namespace nutik::studio
