// A point's time and gain as numbers to type, over the curve editor.
//
//   always:  nothing is changed before both numbers are right; what is wrong with one is said below it. Escape leaves
//            everything as it was; text that was not touched keeps its value to the last digit
#pragma once

#include <QFrame>
#include <functional>

#include "capture/timeline.hpp"
#include "exposure/gain_function.hpp"

class QLabel;
class QLineEdit;

namespace nutik::studio {

class NumberEditor : public QFrame {
  Q_OBJECT  // for tr()

 public:
  // What was typed is right: uses it, or returns why it cannot be used.
  using Use = std::function<QString(const ControlPoint& typed)>;
  NumberEditor(QWidget* parent, Use use);

  // Shows a point near a place in the parent, which has the focus again once this is closed.
  void open(const ControlPoint& point, const Timeline& timeline, QPointF at);
  void close_editor();

 protected:
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void enter();
  void refuse(const QString& why);
  void move_within_parent(QPoint place);

  Use use_;
  ControlPoint point_;
  const Timeline* timeline_ = nullptr;
  QLineEdit* time_;
  QLineEdit* gain_;
  QLabel* mistake_;
};

}  // namespace nutik::studio
