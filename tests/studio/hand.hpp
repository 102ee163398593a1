// A hand that moves the mouse with its left button down, which QTest::mouseMove() does not say.
#pragma once

#include <QApplication>
#include <QMouseEvent>
#include <QTest>
#include <QWidget>

namespace nutik::studio {

inline void move_pressed(QWidget& widget, QPoint to, Qt::KeyboardModifiers keys = {}) {
  QMouseEvent event(QEvent::MouseMove, to, widget.mapToGlobal(to), Qt::NoButton, Qt::LeftButton, keys);
  QApplication::sendEvent(&widget, &event);
}

inline void drag(QWidget& widget, QPoint from, QPoint to, Qt::KeyboardModifiers keys = {}, int steps = 2) {
  QTest::mousePress(&widget, Qt::LeftButton, keys, from);
  for (int i = 1; i <= steps; ++i) move_pressed(widget, from + (to - from) * i / steps, keys);
  QTest::mouseRelease(&widget, Qt::LeftButton, keys, to);
}

// In place of what a field holds.
template <typename Field>
void type_into(Field& field, const QString& text, Qt::Key end = Qt::Key_Return) {
  field.setFocus();
  field.selectAll();
  text.isEmpty() ? QTest::keyClick(&field, Qt::Key_Delete) : QTest::keyClicks(&field, text);
  QTest::keyClick(&field, end);
}

}  // namespace nutik::studio
